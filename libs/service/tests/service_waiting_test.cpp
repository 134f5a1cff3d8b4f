// The waiting list: people who join are screened and seated by what they can do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "faulty_disk.hpp"
#include "kith/service/live_service.hpp"
#include "kith/store/session_review.hpp"
#include "service_hall.hpp"

namespace kith {
namespace {

using testing::exported;
using testing::FaultyDisk;
using ::testing::HasSubstr;
using testing::is_stored;
using ::testing::Not;
using testing::num_rows;
using testing::Page;
using testing::play;
using testing::ScratchFolder;
using testing::Screened;
using testing::small_study;
using testing::Stage;
using testing::stored;

TEST(WaitingList, SeatsPeopleByWhatTheyCanDoAndKeepsTheirLinks) {
  Screened hall;
  auto& able = hall.come("able", true);
  auto& first = hall.come("first", false);
  EXPECT_EQ(able.stage(), "lobby");
  EXPECT_EQ(first.stage(), "lobby");
  EXPECT_EQ(hall.stage.service().num_rooms(), 0u);
  auto& other_able = hall.come("other", true);
  EXPECT_EQ(other_able.stage(), "lobby") << "there is one place for somebody able";
  auto& second = hall.come("second", false);
  for (const auto* page : {&able, &first, &second}) EXPECT_EQ(page->stage(), "watch") << page->name();
  EXPECT_EQ(other_able.stage(), "lobby");
  EXPECT_EQ(able.view()["me"]["label"], "Learner C");
  EXPECT_EQ(first.view()["me"]["label"], "Learner A");
  EXPECT_EQ(hall.stage.service().num_rooms(), 1u);
  EXPECT_EQ(hall.estimates_of("r2"), (std::vector<bool>{false, false, true}));
  EXPECT_EQ(hall.estimates_of("r1"), (std::vector<bool>{true})) << "who has a place is not on the list any more";

  // The same link, another tab.
  Page tab{first.token(), "tab"};
  tab.connect(hall.stage.service());
  hall.settle();
  tab.read();
  EXPECT_EQ(tab.stage(), "watch");
  EXPECT_EQ(first.bye(), "opened-elsewhere");
  tab.disconnect(hall.stage.service());
  first.connect(hall.stage.service());
  hall.settle();

  hall.restart();
  for (const auto* page : {&able, &first, &second}) EXPECT_EQ(page->stage(), "watch") << page->name();
  EXPECT_EQ(other_able.stage(), "lobby");
  hall.come("third", false);
  hall.come("fourth", false);
  EXPECT_EQ(other_able.stage(), "watch");
  ASSERT_TRUE(play(hall.stage, hall.people, hall.solver));
  for (const auto& person : hall.people) EXPECT_EQ(person->stage(), "debrief") << person->name();

  auto file = stored(hall.stage);
  TeachingCache cache{hall.stage.study().study->atlas};
  for (const auto& room : file.rooms()) {
    EXPECT_EQ(replay_room(file, room, hall.stage.study().study, cache).problem, "") << room.number;
  }
  const auto tables = exported(hall.stage, {.with_names = true});
  EXPECT_EQ(num_rows(tables.at("sessions.csv")), 2u);
  EXPECT_EQ(num_rows(tables.at("participants.csv")), 6u);
  EXPECT_THAT(tables.at("participants.csv"), HasSubstr("pid-third"));
  EXPECT_THAT(exported(hall.stage).at("events.csv"), Not(HasSubstr("pid-third")));
}

TEST(WaitingList, SurvivesARestartWhilePeopleWait) {
  Screened hall;
  auto& able = hall.come("able", true);
  auto& first = hall.come("first", false);
  hall.restart();
  EXPECT_EQ(able.stage(), "lobby");
  hall.come("second", false);
  EXPECT_EQ(able.stage(), "watch");
  EXPECT_EQ(first.stage(), "watch");
}

TEST(WaitingList, SendsNobodyHomeWithoutACode) {
  Screened hall{"time = { lobby_s = 60 }\n"};
  auto& able = hall.come("able", true);
  hall.pass(59);
  EXPECT_EQ(able.stage(), "lobby");
  hall.pass(2);
  EXPECT_EQ(able.stage(), "ended");
  EXPECT_NE(able.view()["end"].value("code", ""), "");
  const auto tables = exported(hall.stage, {.with_names = true});
  EXPECT_EQ(num_rows(tables.at("sessions.csv")), 0u);
  EXPECT_EQ(num_rows(tables.at("participants.csv")), 1u);
  EXPECT_THAT(tables.at("participants.csv"), HasSubstr(able.view()["end"]["code"].get<std::string>()));
}

// At once, and only once, however often the service looks for something to do.
TEST(WaitingList, FillsUpWithSimulatedLearnersWhenTheTimeIsOver) {
  Screened hall{"time = { lobby_s = 60 }\ndropout = { policy = \"simulate\" }\n"};
  auto& able = hall.come("able", true);
  hall.pass(61);
  EXPECT_EQ(able.stage(), "watch");
  EXPECT_EQ(hall.stage.service().num_rooms(), 1u);
  ASSERT_TRUE(play(hall.stage, hall.people, hall.solver));
  EXPECT_THAT(exported(hall.stage).at("participants.csv"), HasSubstr("true"));
}

TEST(WaitingList, EndsTheWaitWhenNoRoomCanBeMade) {
  Screened hall{"time = { lobby_s = 60 }\n"};
  hall.stage.change_options = [](LiveServiceOptions& options) { options.max_rooms = 0; };
  hall.restart();
  hall.come("first", false);
  hall.come("second", false);
  auto& able = hall.come("able", true);
  EXPECT_EQ(able.stage(), "lobby");
  hall.pass(125);
  for (const auto& person : hall.people) EXPECT_EQ(person->stage(), "ended") << person->name();
}

// Otherwise only the list would know, and the group wait for ever.
TEST(WaitingList, TellsTheGroupWhoWentAwayWhileItWasSaved) {
  const FaultyDisk disk;
  Screened hall{"time = { lobby_s = 60 }\ndropout = { policy = \"simulate\", grace_s = 30 }\n"};
  hall.come("able", true);
  auto& gone = hall.come("gone", false);
  hall.pass(55);
  gone.disconnect(hall.stage.service());
  FaultyDisk::fail(1, 1'000'000, FaultyDisk::Fault::kFull);
  hall.pass(12);
  EXPECT_EQ(hall.stage.service().num_rooms(), 0u);
  FaultyDisk::heal();
  hall.pass(35);
  EXPECT_EQ(hall.stage.service().num_rooms(), 1u);
  hall.people.pop_back();
  EXPECT_TRUE(play(hall.stage, hall.people, hall.solver, 500));
}

// The room and the people in it are saved together: there is no moment at which somebody is in both places or in none.
TEST(WaitingList, SavesGroupAndListTogether) {
  Screened hall;
  hall.come("able", true);
  hall.come("first", false);
  hall.come("second", false);
  hall.stage.stop();
  auto file = stored(hall.stage);
  std::vector<StoredEvent> seated;
  std::vector<StoredEvent> grouped;
  file.for_each_event([&](const StoredEvent& event) {
    if (event.type == "seated") seated.push_back(event);
    if (event.type == "grouped") grouped.push_back(event);
  });
  ASSERT_EQ(seated.size(), 3u);
  ASSERT_EQ(grouped.size(), 1u);
  EXPECT_EQ(Json::parse(grouped.front().json)["room"], "r2");
  EXPECT_TRUE(is_stored(hall.stage, "pid-able"));
  EXPECT_GT(redact(hall.stage.folder(), std::nullopt, hall.stage.clock().now_us()), 0u);
  EXPECT_FALSE(is_stored(hall.stage, "pid-able"));
  hall.restart();
  for (const auto& person : hall.people) EXPECT_EQ(person->stage(), "watch") << person->name();
}

TEST(WaitingList, IsForTheLinkOfTheStudyOnly) {
  Screened hall;
  const auto page = hall.stage.facilitator();
  page->ask(hall.stage.service(), "room-make", {{"reason", "a group of friends"}});
  hall.stage.service().settle();
  hall.stage.show(*page);
  const auto code = page->view()["rooms"].back()["code"].get<std::string>();
  EXPECT_EQ(page->view()["rooms"].size(), 2u);
  Page friendly{hall.stage.join(code), "friend"};
  friendly.connect(hall.stage.service());
  hall.settle();
  hall.stage.show(*page);
  EXPECT_EQ(page->view()["rooms"].back()["seats"][0]["presence"], "here");
  hall.come("able", true);
  hall.stage.show(*page);
  EXPECT_EQ(page->view()["rooms"].front()["seats"].size(), 1u);
  EXPECT_NE(page->view()["rooms"].front()["seats"][0].value("link", ""), "");
}

// A class opens the link at the same moment.
TEST(LiveService, FillsRoomsAlsoWhenManyJoinAtOnce) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  const auto code = stage.join_code();
  std::vector<std::string> tokens(9);
  {
    std::vector<std::jthread> class_of_nine;
    for (auto& token : tokens) {
      class_of_nine.emplace_back([&] { token = stage.join(code); });
    }
  }
  EXPECT_THAT(tokens, ::testing::Each(Not("")));
  EXPECT_EQ(stage.service().num_rooms(), 3u);
}

}  // namespace
}  // namespace kith
