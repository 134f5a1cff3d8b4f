// What happens to a group when people are away: every policy in every state, with a fast clock (R18).
#include <gtest/gtest.h>

#include <set>

#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

constexpr double kGrace = 20.0;  // seconds

struct DropoutCase {
  std::string policy;
  std::string stage;  // where the leavers are
  std::size_t leavers = 0;
  bool after_grace = false;
};

std::string trace_of(const DropoutCase& tested) {
  return tested.policy + ", " + std::to_string(tested.leavers) + " at " + tested.stage +
         (tested.after_grace ? ", after the grace period" : ", in time");
}

std::string name_of_policy(const ::testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// The policies; all cases of one are one test, so that they share the lessons that they have in common.
class Dropouts : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static std::vector<DropoutCase> cases(const std::string& policy) {
    std::vector<DropoutCase> all;
    for (const std::string stage : {"consent", "check", "screening", "lobby", "wait-lesson", "watch", "wait-watch",
                                    "predict", "wait-answer", "feedback", "wait-feedback", "questions", "debrief"}) {
      const bool is_wait = stage.rfind("wait-", 0) == 0 || stage == "lobby";
      for (const std::size_t leavers : {1u, 2u, 3u}) {
        if (leavers == 3 && is_wait && stage != "wait-lesson") continue;  // then nobody waits
        for (const bool after : {false, true}) all.push_back({policy, stage, leavers, after});
      }
    }
    return all;
  }

  // Everybody is brought to the stage; who comes there by themselves is a leaver.
  static void bring_to(Play& play, const std::string& stage, std::size_t leavers) {
    const auto act_all = [&] {
      for (std::size_t i = 1; i <= 3; ++i) play.act(i);
    };
    if (stage == "consent" || stage == "check" || stage == "screening" || stage == "lobby") {
      play.join(3);
      for (std::size_t i = 1; i <= 3; ++i) {
        if (stage == "consent") continue;
        ASSERT_EQ(play.seat(i, "consent", {{"accept", true}, {"version", "1"}}), "");
        if (stage == "check") continue;
        ASSERT_EQ(play.seat(i, "checked"), "");
        if (stage == "lobby" && i <= leavers) play.get_ready(i);
      }
      return;
    }
    play.join(play.room().has_free_seat() ? 3 : 0);
    for (std::size_t i = 1; i < 3; ++i) play.get_ready(i);
    if (stage == "wait-lesson") play.set_teacher(false);
    play.get_ready(3);
    if (stage == "wait-lesson") return;
    if (stage == "watch") return;
    if (stage == "wait-watch") {
      for (std::size_t i = 1; i <= std::min<std::size_t>(leavers, 2); ++i) play.watch(i);
      return;
    }
    act_all();
    if (stage == "predict") return;
    if (stage == "wait-answer") {
      for (std::size_t i = 1; i <= std::min<std::size_t>(leavers, 2); ++i) play.answer(i);
      return;
    }
    act_all();
    if (stage == "feedback") return;
    if (stage == "wait-feedback") {
      for (std::size_t i = 1; i <= std::min<std::size_t>(leavers, 2); ++i) ASSERT_EQ(play.seat(i, "continue"), "");
      return;
    }
    play.play_on({1, 2, 3});
    ASSERT_EQ(play.room().stage_of(1), "questions");
    if (stage == "questions") return;
    for (std::size_t i = 1; i <= leavers; ++i) {
      ASSERT_EQ(play.seat(i, "questions", {{"answers", Json::object()}}), "");
    }
  }

  // @param replays  whether the room is taught once more at the end, which takes most of the time.
  static void check(const DropoutCase& tested, bool replays) {
    const auto& [policy, stage, leavers, after_grace] = tested;
    Play play{live_study("[group]\ndropout = { policy = \"" + policy +
                         "\", grace_s = 20 }\nscreening = { tests = 1 }\n"
                         "questions = [{ id = \"a\", kind = \"text\", text = \"?\" }]\n")};
    bring_to(play, stage, leavers);
    if (HasFatalFailure()) return;
    const bool in_lobby = stage == "consent" || stage == "check" || stage == "screening" || stage == "lobby";
    const bool at_end = stage == "questions" || stage == "debrief";
    std::vector<std::string> before;
    for (std::size_t i = 1; i <= 3; ++i) before.push_back(play.room().stage_of(i));

    for (std::size_t i = 1; i <= leavers; ++i) {
      ASSERT_EQ(play.send("server", "away", {{"seat", i}}), "");
    }
    play.wait(after_grace ? kGrace + 1.0 : kGrace - 1.0);

    if (!after_grace) {
      // Whoever returns in time finds the same page.
      for (std::size_t i = 1; i <= leavers; ++i) {
        ASSERT_EQ(play.send("server", "present", {{"seat", i}}), "");
      }
      if (policy == "continue-now" && !in_lobby && !at_end) {
        EXPECT_EQ(play.room().stage(), leavers == 3 ? RoomStage::kEnded : RoomStage::kRunning);
      } else {
        for (std::size_t i = 1; i <= 3; ++i) EXPECT_EQ(play.room().stage_of(i), before[i - 1]) << i;
      }
    } else if (in_lobby) {
      for (std::size_t i = 1; i <= leavers; ++i) EXPECT_EQ(play.room().stage_of(i), "replaced");
      EXPECT_TRUE(play.room().has_free_seat());  // the others wait for somebody new
    } else if (at_end) {
      for (std::size_t i = 1; i <= 3; ++i) EXPECT_EQ(play.room().stage_of(i), before[i - 1]) << i;
      const bool done = leavers == 3;  // nobody is waited for
      EXPECT_EQ(play.room().stage(), done ? RoomStage::kEnded : RoomStage::kQuestions);
    } else if (policy == "end-group" || leavers == 3) {
      EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
      const auto third = play.room().stage_of(3);
      EXPECT_TRUE(third == "ended" || third == "replaced") << third;
      EXPECT_TRUE(play.room().view({Viewer::Role::kParticipant, 3}, play.now())["end"].contains("code"));
    } else {
      EXPECT_EQ(play.room().stage(), RoomStage::kRunning);
      EXPECT_EQ(play.room().stage_of(1), policy == "simulate" ? "replaced" : "wait");
      EXPECT_NE(play.room().stage_of(3), "replaced");  // active members are never removed
    }

    // Nobody who is there waits longer than the grace period, whatever the others do; and the session comes to an end.
    play.set_teacher(true);
    if (!in_lobby && play.room().stage() == RoomStage::kRunning) {
      for (int i = 0; i < 600 && play.room().stage() == RoomStage::kRunning; ++i) {
        for (std::size_t seat = 1; seat <= play.room().num_seats(); ++seat) {
          const bool left = seat <= leavers && after_grace;
          if (play.room().is_person(seat) && !left) play.act(seat);
        }
        if (i % 3 != 0) continue;
        play.wait(kGrace + 5.0);
        // Somebody who is there can do something: whoever was waited for has been away for longer than that.
        bool can_act = play.room().stage() != RoomStage::kRunning;
        for (std::size_t seat = 1; seat <= play.room().num_seats(); ++seat) {
          const bool left = seat <= leavers && after_grace;
          const auto stage_now = play.room().stage_of(seat);
          can_act = can_act || (!left && (stage_now == "watch" || stage_now == "predict" || stage_now == "feedback"));
        }
        ASSERT_TRUE(can_act);
      }
      EXPECT_NE(play.room().stage(), RoomStage::kRunning);
    }
    if (replays) play.expect_replay();
  }
};
using DropoutsSlow = Dropouts;

TEST_P(Dropouts, LeadToTheRightStateInTime) {
  for (const auto& tested : cases(GetParam())) {
    SCOPED_TRACE(trace_of(tested));
    check(tested, tested.stage == "predict" && tested.leavers == 1);
  }
}

TEST_P(DropoutsSlow, ReplayFromEveryState) {
  for (const auto& tested : cases(GetParam())) {
    SCOPED_TRACE(trace_of(tested));
    check(tested, true);
  }
}

constexpr const char* kPolicies[] = {"pause-then-continue", "continue-now", "simulate", "end-group"};
INSTANTIATE_TEST_SUITE_P(R18, Dropouts, ::testing::ValuesIn(kPolicies), name_of_policy);
INSTANTIATE_TEST_SUITE_P(R18, DropoutsSlow, ::testing::ValuesIn(kPolicies), name_of_policy);

TEST(Dropout, AreLeftOutOfTheTeachersBeliefs) {
  Play play{live_study("[group]\ndropout = { policy = \"continue-now\" }\n")};
  play.start_tests(3);
  ASSERT_EQ(play.send("server", "away", {{"seat", 2}}), "");
  const auto frozen = play.room().session().belief().member(1);
  play.play_on({1, 3}, false, 6);
  EXPECT_GT(play.room().session().periods(), 1u);
  EXPECT_EQ(play.room().session().belief().member(1), frozen);
  ASSERT_EQ(play.send("server", "present", {{"seat", 2}}), "");
  EXPECT_EQ(play.room().stage_of(2), "wait");
  play.play_on({1, 3}, false, 4);
  EXPECT_EQ(play.room().stage_of(2), "watch");  // from the next lesson on
  play.expect_replay();
}

TEST(Dropout, EndTheSessionBelowTheLeastNumberOfPeople) {
  Play play{live_study("[group]\ndropout = { policy = \"continue-now\", min_active = 3 }\n")};
  play.start(3);
  ASSERT_EQ(play.seat(1, "leave"), "");
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
  EXPECT_EQ(play.room().stage_of(2), "ended");
  EXPECT_EQ(play.room().view({Viewer::Role::kParticipant, 2}, play.now())["end"]["reason"], "too-few");
}

}  // namespace
}  // namespace kith
