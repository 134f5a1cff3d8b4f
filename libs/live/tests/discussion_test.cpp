// Groups that see each other's answers before the feedback.

#include <gtest/gtest.h>

#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::page;
using testing::Play;

std::string talks(const std::string& model, const std::string& more = {}) {
  return "[group]\n" + more + "[group.discussion]\nmodel = \"" + model + "\"\n";
}

// Three people in the stage: the first and the third are right, the second is wrong.
void begin(Play& play) {
  play.start_tests(3);
  for (std::size_t i = 1; i <= 3; ++i) play.answer(i, i != 2);
}

TEST(Discussion, ShowsWhatTheGroupPredictedWithoutNames) {
  Play play{live_study(talks("majority"))};
  begin(play);
  ASSERT_EQ(play.room().stage_of(1), "discuss");
  const auto first = page(play, 1)["discuss"], second = page(play, 2)["discuss"], third = page(play, 3)["discuss"];
  ASSERT_EQ(first["predictions"].size(), 2u);
  EXPECT_EQ(first, third);  // they gave the same answer, so their pages are the same
  const auto without_own = [](Json shown) {
    for (auto& one : shown["predictions"]) one.erase("own");
    return shown;
  };
  EXPECT_EQ(without_own(first), without_own(second));
  std::size_t all = 0, own = 0;
  for (const auto& one : second["predictions"]) {
    all += one["n"].get<std::size_t>();
    own += one["own"].get<bool>() ? one["n"].get<std::size_t>() : 0u;
  }
  EXPECT_EQ(all, 3u);
  EXPECT_EQ(own, 1u);
  for (const auto& one : second["predictions"]) {
    EXPECT_EQ(one.size(), 3u) << one;
    for (const char* member : {"frames", "own", "n"}) EXPECT_TRUE(one.contains(member)) << member;
  }
}

TEST(Discussion, ComesBetweenTheAnswersAndTheFeedback) {
  Play play{live_study(talks("majority"))};
  begin(play);
  const auto tests = play.room().session().lesson().tests.size();
  for (std::size_t t = 0; t < tests && play.room().stage_of(2) == "discuss"; ++t) EXPECT_EQ(play.discuss(2, false), "");
  EXPECT_EQ(play.room().stage_of(2), "wait");
  EXPECT_EQ(page(play, 2)["wait"]["for"], "discussion");
  for (const std::size_t seat : {1u, 3u}) {
    while (play.room().stage_of(seat) == "discuss") EXPECT_EQ(play.discuss(seat), "");
  }
  ASSERT_EQ(play.room().stage_of(2), "feedback");
  const auto& past = play.room().session().history().back();
  EXPECT_FALSE(past.feedback.all_correct[1]);  // by the first answers
  EXPECT_TRUE(past.feedback.all_right_in_the_end(1));
  EXPECT_TRUE(page(play, 2)["feedback"]["all_right"].get<bool>());
  const auto detail = play.room().view({Viewer::Role::kFacilitator, 0}, play.now())["room"];
  std::size_t changed = 0;
  for (const auto& answer : detail["answers"]) {
    changed += answer["changed"].get<bool>() ? 1u : 0u;
    EXPECT_TRUE(answer["right_in_the_end"].get<bool>());
  }
  EXPECT_GT(changed, 0u);
  play.expect_replay();
}

TEST(Discussion, IsReplayedInTheMiddleOfTheStage) {
  Play play{live_study(talks("degroot")), "NNP", {false, false, true}};
  play.start_tests(2);
  play.answer(1, true);
  play.answer(2, false);
  ASSERT_EQ(play.room().stage_of(1), "discuss");
  EXPECT_EQ(play.discuss(1, false), "");
  play.expect_replay();
  while (play.room().stage_of(1) == "discuss") play.discuss(1);
  while (play.room().stage_of(2) == "discuss") play.discuss(2, false);
  EXPECT_EQ(play.room().stage_of(1), "feedback");
  play.expect_replay();
}

TEST(Discussion, ASecondTabCannotDecideOtherwise) {
  Play play{live_study(talks("majority"))};
  begin(play);
  const Json kept{{"test", page(play, 1)["discuss"]["index"]}, {"choice", nullptr}, {"ms", 5}};
  auto taken = kept;
  taken["choice"] = 0;
  taken["round"] = 2;
  EXPECT_EQ(play.seat(1, "discuss", taken), "too-late");  // another round's
  taken.erase("round");
  EXPECT_EQ(play.seat(1, "discuss", kept), "");
  EXPECT_EQ(play.seat(1, "discuss", kept), "");  // sent again
  EXPECT_EQ(play.seat(1, "discuss", taken), "already-answered");
  taken["choice"] = 99;
  EXPECT_EQ(play.seat(2, "discuss", taken), "bad-body");
  EXPECT_EQ(play.seat(1, "answer", {{"test", 0}, {"actions", Json::array()}, {"keys", Json::array()}, {"ms", 1}}),
            "too-late");
}

TEST(Discussion, WhoLeavesKeepsTheirAnswersAndTheOthersGoOn) {
  Play play{live_study(talks("majority"))};
  begin(play);
  EXPECT_EQ(play.seat(2, "leave"), "");
  for (const std::size_t seat : {1u, 3u}) {
    while (play.room().stage_of(seat) == "discuss") EXPECT_EQ(play.discuss(seat), "");
  }
  EXPECT_EQ(play.room().stage_of(1), "feedback");
  EXPECT_TRUE(play.room().session().history().back().revised[1].empty());
  play.expect_replay();
}

TEST(Discussion, IsOverWhenItsTimeIs) {
  Play play{live_study(talks("majority", "time = { discuss_s = 20 }\n"))};
  begin(play);
  EXPECT_TRUE(page(play, 1).contains("limit_ms"));
  play.wait(21.0);
  EXPECT_EQ(play.room().stage_of(1), "feedback");
  play.expect_replay();
}

// Only another person's answer differs: the bytes are the same until the stage begins.
TEST(Discussion, NothingShowsBeforeTheStage) {
  const auto study = live_study(talks("truth-wins"));
  Play a{study}, b{study};
  for (auto* play : {&a, &b}) play->start_tests(3);
  const auto same = [&] {
    for (const std::size_t viewer : {1u, 3u}) EXPECT_EQ(page(a, viewer).dump(), page(b, viewer).dump());
  };
  a.answer(2, true);  // the only difference
  b.answer(2, false);
  same();
  a.answer(1);
  b.answer(1);
  same();
  a.answer(3);
  b.answer(3);
  EXPECT_NE(page(a, 1).dump(), page(b, 1).dump());
}

}  // namespace
}  // namespace kith
