// What facilitators do to a room, and what they see of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/live/room.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::live_study;
using testing::page;
using testing::Play;

TEST(RoomFacilitator, LetsFacilitatorsInterveneWithAReason) {
  Play play{live_study("[group]\nauto_start = false\nask_name = true\n")};
  play.start(3);
  EXPECT_EQ(play.room().stage(), RoomStage::kLobby);
  ASSERT_EQ(play.facilitator("message", {{"text", "Soon."}}), "");
  ASSERT_EQ(play.facilitator("message", {{"text", "You."}, {"seat", 2}}), "");
  EXPECT_EQ(page(play, 1)["notices"].size(), 1u);
  EXPECT_EQ(page(play, 2)["notices"].size(), 2u);
  ASSERT_EQ(play.facilitator("start"), "");
  EXPECT_EQ(play.room().stage_of(1), "watch");
  ASSERT_EQ(play.facilitator("simulate", {{"seat", 3}, {"type", "P"}}), "");
  EXPECT_EQ(play.room().stage_of(3), "replaced");
  EXPECT_EQ(play.room().num_seats(), 4u);
  EXPECT_FALSE(play.room().is_person(4));
  play.play_on({1, 2}, false, 3);
  EXPECT_TRUE(play.room().session().takes_part(2));  // the stand-in, from the next lesson on
  ASSERT_EQ(play.facilitator("readmit", {{"seat", 3}}), "");
  for (int i = 0; i < 3; ++i) play.play_on({1, 2, 3}, false, 3);
  EXPECT_TRUE(play.room().session().takes_part(2));
  EXPECT_EQ(play.room().stage(), RoomStage::kRunning);
  EXPECT_EQ(play.facilitator("end"), "");
  EXPECT_EQ(play.room().stage_of(1), "ended");
  EXPECT_TRUE(page(play, 1)["end"].contains("code"));
  EXPECT_EQ(body_of(play.events().back())["reason"], "a test");
  EXPECT_EQ(play.facilitator("pause"), "not-now");
  play.expect_replay();
}

TEST(RoomFacilitator, ChangesTheStrategyWithTheNextComponent) {
  Play play{live_study()};
  play.start(3);
  ASSERT_EQ(play.facilitator("strategy", {{"name", "joint"}}), "");
  EXPECT_EQ(play.room().session().strategy().name, "common");
  play.play_on({1, 2, 3});
  EXPECT_EQ(play.room().session().strategy().name, "joint");
  const auto& history = play.room().session().history();
  for (const auto& past : history) {
    EXPECT_EQ(past.lesson.source.rule, past.lesson.component == history.front().lesson.component ? "common" : "joint");
  }
  play.expect_replay();
}

TEST(RoomFacilitator, ShowsTheFacilitatorSinceWhenPeopleAreAtTheirStage) {
  Play play{live_study("[group]\ndropout = { policy = \"simulate\", grace_s = 20 }\n")};
  const auto seat = [&](std::size_t number) {
    return play.room().row({Viewer::Role::kFacilitator, 0})["seats"][number - 1];
  };
  const auto now_ms = [&] { return play.now() / 1000; };
  EXPECT_FALSE(seat(1).contains("stage_since_ms"));  // nobody has come
  play.start(3, 2);
  const auto ready = now_ms();
  play.wait(3);
  ASSERT_EQ(play.seat(3, "consent", {{"accept", true}, {"version", "1"}}), "");
  EXPECT_EQ(seat(1)["stage_since_ms"], ready);
  EXPECT_EQ(seat(3)["stage_since_ms"], now_ms());
  play.wait(2);
  ASSERT_EQ(play.seat(3, "checked"), "");
  EXPECT_EQ(seat(1)["stage"], "watch");
  EXPECT_EQ(seat(1)["stage_since_ms"], now_ms());  // the whole group began
  play.wait(4);
  play.watch(1);
  EXPECT_EQ(seat(1)["stage"], "wait");
  EXPECT_EQ(seat(1)["stage_since_ms"], now_ms());
  EXPECT_EQ(seat(2)["stage_since_ms"], now_ms() - 4000);
  ASSERT_EQ(play.send("server", "away", {{"seat", 2}}), "");
  play.wait(21);
  EXPECT_EQ(seat(2)["stage"], "replaced");
  EXPECT_EQ(seat(4)["member"], 2);  // the stand-in's seat is a new one
  EXPECT_FALSE(seat(1).contains("member"));
}

TEST(RoomFacilitator, ShowsTheFacilitatorWhyALessonWasChosen) {
  const auto study = live_study("[group]\nask_name = true\n");
  TeachingCache cache{study->atlas};
  Room room{
      study, {.id = "r", .code = "ABC", .strategy = "common", .composition = "NN", .simulated = {true, false}}, cache};
  const auto send = [&](const RoomCommand& command) {
    for (const auto& event : room.decide(command, 5'000'000).events) room.apply(event, cache);
  };
  send({"server", "join", Json::object(), ""});
  send({"seat:2", "consent", {{"accept", true}, {"version", "1"}}, ""});
  send({"seat:2", "name", {{"name", "Ada"}}, ""});
  send({"seat:2", "checked", Json::object(), ""});
  for (const auto& event : room.due(5'000'000)) room.apply(event, cache);
  const auto lesson = room.teaching()->run(cache, 3);
  room.apply(room.taught(lesson, 6'000'000), cache, &lesson);
  const auto view = room.view({Viewer::Role::kFacilitator, 0}, 6'000'000);
  EXPECT_EQ(view["row"]["code"], "ABC");
  EXPECT_EQ(view["row"]["seats"][1]["name"], "Ada");
  EXPECT_EQ(view["row"]["seats"][0]["kind"], "simulated");
  const auto& detail = view["room"];
  EXPECT_EQ(detail["lesson"]["source"], "common");
  EXPECT_THAT(detail["lesson"]["why"].get<std::string>(), HasSubstr("what all members know"));
  EXPECT_GT(detail["lesson"]["demonstrations"].size(), 0u);
  EXPECT_GT(detail["lesson"]["runners_up"].size(), 0u);
  EXPECT_GT(detail["lesson"]["runners_up"][0]["gain"], 1.0);
  EXPECT_EQ(detail["beliefs"].size(), 4u);
  EXPECT_EQ(detail["beliefs"][0]["points"].get<std::string>().size(), 300u * 6u / 3u * 4u);
  EXPECT_GE(detail["truth"]["bec"].size(), 3u);
  EXPECT_EQ(detail["truth"]["features"], Json(study->atlas->domain().feature_names()));
  EXPECT_EQ(detail["truth"]["weights"].size(), 3u);
  const auto observer = room.view({Viewer::Role::kObserver, 0}, 6'000'000);
  EXPECT_FALSE(observer["row"].contains("code"));
  EXPECT_FALSE(observer["row"]["seats"][1].contains("name"));
}

}  // namespace
}  // namespace kith
