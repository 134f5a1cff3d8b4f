// Rooms that have ended: what the server keeps of them, and what everybody still finds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/store/session_review.hpp"
#include "service_group.hpp"

namespace kith {
namespace {

using testing::exported;
using testing::Group;
using testing::kQuestions;
using testing::next_step;
using ::testing::Not;
using testing::Page;
using testing::play;
using testing::play_until;
using testing::Stage;
using testing::stored;

// What a facilitator sees of the first room.
Json detail_of(Stage& stage) {
  const auto page = stage.facilitator();
  page->ask(stage.service(), "room-select", {{"room", page->view()["rooms"].front()["id"]}});
  stage.show(*page);
  const auto detail = page->view().value("room", Json{});
  page->disconnect(stage.service());
  return detail;
}

// The page of whoever opens this link anew.
Json page_of(Stage& stage, const std::string& token) {
  const auto page = testing::open_page_of(stage, token);
  page->disconnect(stage.service());
  auto view = page->view();
  if (view.is_object()) view.erase("server_ms");
  return view;
}

TEST(EndedRoom, KeepsNoSession) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "watch"));
  EXPECT_GE(stage.service().num_sessions(), 1u);
  ASSERT_TRUE(play_until(stage, people, solver, "questions"));
  EXPECT_EQ(stage.service().num_sessions(), 0u);
  ASSERT_TRUE(play(stage, people, solver));
  EXPECT_EQ(stage.service().num_sessions(), 0u);
  group.restart();
  EXPECT_EQ(stage.service().num_sessions(), 0u);
  EXPECT_EQ(stage.service().num_rooms(), 1u);
}

TEST(EndedRoom, KeepsNoSessionIfAFacilitatorEndedIt) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto page = stage.facilitator();
  page->ask(stage.service(), "end", {{"room", page->view()["rooms"].front()["id"]}, {"reason", "fire alarm"}});
  stage.service().settle();
  EXPECT_EQ(stage.service().num_sessions(), 0u);
}

TEST(EndedRoom, IsFoundAsItWasByEverybodyAlsoAfterARestart) {
  Group group{kQuestions};
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play(stage, people, solver));
  ASSERT_EQ(stage.service().num_sessions(), 0u);
  std::vector<Json> pages;
  for (const auto& person : people) {
    pages.push_back(page_of(stage, person->token()));
    EXPECT_EQ(pages.back()["stage"], "debrief");
    EXPECT_FALSE(pages.back()["debrief"]["code"].get<std::string>().empty());
    EXPECT_GT(pages.back()["debrief"]["rounds"], 0);
    EXPECT_THAT(pages.back()["debrief"]["summary"], Not(::testing::IsEmpty()));
  }
  const auto detail = detail_of(stage);
  EXPECT_FALSE(detail["beliefs"].empty());
  EXPECT_FALSE(detail["curves"].empty());
  EXPECT_FALSE(detail["answers"].empty());
  EXPECT_TRUE(detail.contains("lesson"));
  const auto tables = exported(stage);
  EXPECT_EQ(stage.service().num_sessions(), 0u);

  group.restart();
  for (std::size_t i = 0; i < people.size(); ++i) EXPECT_EQ(page_of(stage, people[i]->token()), pages[i]);
  EXPECT_EQ(detail_of(stage), detail);
  auto again = exported(stage);
  for (const auto* name : {"sessions.csv", "tests.csv", "beliefs.csv", "periods.csv"}) {
    ASSERT_EQ(again.count(name), 1u) << name;
    EXPECT_EQ(again.at(name), tables.at(name)) << name;
  }
  auto file = stored(stage);
  TeachingCache cache{stage.study().study->atlas};
  EXPECT_EQ(replay_room(file, file.rooms().front(), stage.study().study, cache).problem, "");
}

// A message whose acknowledgement was lost is sent again, perhaps after the end.
TEST(EndedRoom, AcknowledgesWhatItHasAlreadySaved) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  const auto step = next_step(people[0]->view(), solver, true);
  const Page::Message message{.id = "lost-ack", .type = step->first, .body = step->second};
  people[0]->send(stage.service(), message);
  stage.service().settle();
  ASSERT_TRUE(play(stage, people, solver));
  for (const bool restarts : {false, true}) {
    if (restarts) group.restart();
    people[0]->send(stage.service(), message);
    group.settle();
    EXPECT_EQ(people[0]->acks().back(), "lost-ack");
  }
}

// Every wrong answer makes another lesson likely. The ones before are of no use, and each of them is a session.
TEST(RunningRoom, KeepsNoLessonThatIsNoLongerLikely) {
  Group group;
  auto& [scratch, stage, solver, people] = group;
  ASSERT_TRUE(play_until(stage, people, solver, "predict"));
  std::size_t answers = 0;
  for (auto& person : people) {
    while (person->stage() == "predict") {
      group.act(*person, false);
      EXPECT_LE(stage.service().num_sessions(), 2u) << ++answers;
    }
  }
}

}  // namespace
}  // namespace kith
