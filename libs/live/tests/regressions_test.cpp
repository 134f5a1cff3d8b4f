// What users of other platforms lived through; each test is named after it.
#include <gtest/gtest.h>

#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::page;
using testing::Play;

// https://github.com/empiricaly/empirica/issues/579 and 598: an unready member leaves the whole group loading.
TEST(LobbyRegression, AnUnreadyMemberDoesNotLeaveTheGroupLoading) {
  Play play{live_study("[group]\ntime = { lobby_s = 120 }\n")};
  play.start(3, 2);
  EXPECT_EQ(page(play, 1)["lobby"]["present"], 2);
  EXPECT_GT(page(play, 1)["lobby"]["until_ms"], page(play, 1)["server_ms"]);  // the page says until when
  play.wait(119);
  EXPECT_EQ(play.room().stage_of(1), "lobby");
  play.wait(2);
  EXPECT_EQ(play.room().stage_of(1), "ended");
  EXPECT_TRUE(page(play, 1)["end"].contains("code"));
  EXPECT_FALSE(page(play, 3)["end"].contains("code"));  // never was ready
  play.expect_replay();
}

TEST(LobbyRegression, SomebodyElseTakesTheSeatOfAMemberWhoClosedTheBrowser) {
  Play play{live_study("[group]\ndropout = { grace_s = 30 }\n")};
  play.start(3, 2);
  ASSERT_EQ(play.send("server", "away", {{"seat", 3}}), "");
  EXPECT_EQ(play.send("server", "join"), "full");
  play.wait(31);
  EXPECT_EQ(play.room().stage_of(3), "replaced");
  ASSERT_EQ(play.send("server", "join"), "");
  play.get_ready(4);
  EXPECT_EQ(play.room().stage_of(4), "watch");
  EXPECT_EQ(page(play, 4)["me"]["label"], "Learner C");
  EXPECT_EQ(play.room().stage_of(3), "replaced");  // the old link does not show the new person's page
}

// Consenting led to a refusal, and nothing else was possible.
TEST(LobbyRegression, WhoeverOpensALinkAfterTheEndIsToldSo) {
  Play play{live_study()};
  ASSERT_EQ(play.send("server", "join", {{"seat", 1}}), "");
  play.get_ready(1);
  ASSERT_EQ(play.facilitator("end"), "");
  EXPECT_EQ(play.send("server", "join", {{"seat", 2}}), "started");
  EXPECT_EQ(play.room().stage_of(2), "ended");
  EXPECT_TRUE(play.room().is_done(2));
  EXPECT_EQ(page(play, 2)["end"]["text"], "The session was ended by the people who run it.");
  EXPECT_FALSE(page(play, 2)["end"].contains("code"));
  play.expect_replay();
}

// deliberate-lab #335: everyone stuck after a kick.
TEST(PlayRegression, AKickedMemberDoesNotLeaveTheGroupStuck) {
  for (int watched = 0; watched < 2; ++watched) {
    Play play{live_study()};
    play.start(3);
    for (const std::size_t i : {1u, 2u}) play.watch(i);
    if (watched == 1) {
      play.watch(3);
      for (const std::size_t i : {1u, 2u}) play.answer(i);
    }
    EXPECT_EQ(play.room().stage_of(1), "wait");
    ASSERT_EQ(play.facilitator("simulate", {{"seat", 3}, {"type", "P"}}), "");
    EXPECT_EQ(play.room().stage_of(3), "replaced");
    EXPECT_EQ(play.room().stage_of(1), watched == 1 ? "feedback" : "predict");
    play.play_on({1, 2});
    EXPECT_EQ(play.room().stage_of(1), "debrief");
    play.expect_replay();
  }
}

// JATOS #336: active members removed by a cleaner.
TEST(PlayRegression, ActiveMembersAreNeverRemoved) {
  Play play{live_study("[group]\ndropout = { grace_s = 10 }\n")};
  play.start(3);
  play.wait(7 * 86'400.0);  // slow, but there
  for (std::size_t i = 1; i <= 3; ++i) EXPECT_EQ(play.room().stage_of(i), "watch");
  EXPECT_EQ(play.room().next_due(), std::nullopt);
}

// Empirica #79: stuck at 60 minutes; deliberate-lab #357: counts that need a refresh.
TEST(LobbyRegression, TimesAreKept) {
  Play play{live_study("[group]\ntime = { lobby_s = 600, leave_after_s = 60 }\n")};
  play.start(3, 1);
  EXPECT_EQ(page(play, 1)["lobby"]["leave_after_ms"], play.now() / 1000 + 60'000);
  play.wait(30);
  play.get_ready(2);
  EXPECT_EQ(page(play, 1)["lobby"]["present"], 2);
  play.wait(31);
  EXPECT_LT(page(play, 1)["lobby"]["leave_after_ms"], play.now() / 1000);
  EXPECT_GT(page(play, 2)["lobby"]["leave_after_ms"], play.now() / 1000);
  ASSERT_EQ(play.seat(1, "leave"), "");
  EXPECT_TRUE(page(play, 1)["end"].contains("code"));  // the promised time was waited
  EXPECT_EQ(page(play, 2)["lobby"]["present"], 1);
  play.wait(600);
  EXPECT_EQ(play.room().stage_of(2), "ended");
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
}

TEST(LobbyRegression, OnePersonMoreThanSeatsGetsAPage) {
  Play play{live_study(), "NN"};
  play.start(2);
  const auto late = play.room().decide({"server", "join", Json::object(), ""}, play.now());
  ASSERT_TRUE(late.refusal);
  EXPECT_EQ(late.refusal->reason, "started");
  const auto view = full_view(play.study(), "CODE", Json::object(), play.now());
  EXPECT_EQ(view["stage"], "full");
  EXPECT_EQ(view["end"]["code"], "CODE");
  EXPECT_FALSE(view["end"]["text"].get<std::string>().empty());
  const auto unpaid = live_study("[group]\ncompletion = { pay_full = false }\n");
  EXPECT_FALSE(full_view(*unpaid, "CODE", Json::object(), 0)["end"].contains("code"));
}

TEST(LobbyRegression, OnePersonFewerThanSeatsCanBeStartedByHandOrFilledUp) {
  Play play{live_study("[group]\nauto_start = false\n")};
  play.start(2);
  play.wait(86'400);
  EXPECT_EQ(play.room().stage_of(1), "lobby");  // the facilitator decides
  ASSERT_EQ(play.facilitator("start"), "");
  EXPECT_EQ(play.room().stage_of(1), "watch");
  EXPECT_EQ(play.room().stage_of(3), "full");  // nobody can come any more
  play.play_on({1, 2});
  EXPECT_EQ(play.room().stage_of(2), "debrief");

  Play filled{live_study("[group]\ntime = { lobby_s = 60 }\ndropout = { policy = \"simulate\" }\n")};
  filled.start(3, 1);
  filled.wait(61);
  EXPECT_EQ(filled.room().stage_of(1), "watch");
  EXPECT_EQ(filled.room().num_seats(), 5u);  // two stand-ins
  filled.play_on({1});
  EXPECT_EQ(filled.room().stage_of(1), "debrief");
  filled.expect_replay();
}

// Dallinger #2510: a participant joins after the start.
TEST(PlayRegression, NobodyJoinsAfterTheStart) {
  Play play{live_study("[group]\nauto_start = false\n")};
  play.join(3);
  EXPECT_EQ(play.send("server", "join"), "full");
  for (const std::size_t i : {1u, 2u, 3u}) play.get_ready(i);
  ASSERT_EQ(play.facilitator("start"), "");
  EXPECT_EQ(play.send("server", "join"), "started");
  EXPECT_EQ(play.send("server", "join", {{"seat", 2}}), "started");
}

// Multi-User Gymnasium: reconnecting restarts the scene.
TEST(PlayRegression, WhoReturnsFindsTheirHalfDrawnPath) {
  Play play{live_study()};
  play.start_tests(3);
  auto path = play.right_path(play.room().session().lesson().tests.front().start);
  path.erase(path.end() - 1);
  ASSERT_EQ(play.seat(1, "draft", {{"test", 0}, {"actions", path}}), "");
  ASSERT_EQ(play.send("server", "away", {{"seat", 1}}), "");
  play.wait(60);
  ASSERT_EQ(play.send("server", "present", {{"seat", 1}}), "");
  EXPECT_EQ(page(play, 1)["predict"]["draft"], path);
}

TEST(PlayRegression, WaitingSaysForWhomAndUntilWhen) {
  Play play{live_study("[group]\ndropout = { grace_s = 60 }\n")};
  play.start(3);
  play.watch(1);
  ASSERT_EQ(play.send("server", "away", {{"seat", 3}}), "");
  EXPECT_FALSE(page(play, 1).contains("pause"));  // the second person is still at work
  play.watch(2);
  const auto view = page(play, 1);
  EXPECT_EQ(view["wait"]["missing"], 1);
  EXPECT_EQ(view["pause"]["why"], "someone-away");
  EXPECT_EQ(view["pause"]["until_ms"].get<std::int64_t>() - view["pause"]["since_ms"].get<std::int64_t>(), 60'000);
}

TEST(PlayRegression, WhoDeclinesFreesTheSeatAndLeavesNoTrace) {
  Play play{live_study("[group]\ncollect_query = [\"PID\"]\n"), "NN"};
  ASSERT_EQ(play.send("server", "join"), "");
  ASSERT_EQ(play.seat(1, "consent", {{"accept", false}, {"version", "1"}}), "");
  EXPECT_EQ(play.room().stage_of(1), "declined");
  EXPECT_FALSE(page(play, 1)["end"].contains("code"));
  EXPECT_EQ(body_of(play.events().back()), Json::object());
  play.join(2);
  play.get_ready(2);
  play.get_ready(3);
  EXPECT_EQ(play.room().stage_of(2), "watch");
  EXPECT_EQ(play.room().stage_of(1), "declined");
  play.expect_replay();
}

}  // namespace
}  // namespace kith
