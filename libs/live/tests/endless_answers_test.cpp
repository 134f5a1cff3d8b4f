// People predict that a robot never arrives: the path goes on like this for ever.
#include <gtest/gtest.h>

#include <set>

#include "discounted_domains.hpp"
#include "live_play.hpp"
#include "path_features.hpp"

namespace kith {
namespace {

using testing::Play;

std::shared_ptr<const LiveStudy> study_at(double discount, const std::string& group = {}) {
  const auto reading =
      parse_study(testing::kLiveStudy + group, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  if (!reading.study) throw std::logic_error{to_text(reading.diagnostics.front())};
  return make_live_study(*reading.study,
                         std::make_shared<const Atlas>(testing::discounted_domain("item-delivery", discount)));
}

const std::shared_ptr<const LiveStudy>& discounted_study() {
  static const auto study = study_at(0.7);
  return study;
}

std::vector<std::size_t> numbers_of(const Trajectory& path) {
  std::vector<std::size_t> numbers;
  for (const auto action : path.actions) numbers.push_back(action.value());
  return numbers;
}

double return_of(const Atlas& atlas, const IntegerVector& counts) {
  return atlas.domain().weights().return_of(counts) / static_cast<double>(atlas.domain().count_scale());
}

TEST(EndlessAnswers, ArePossibleExactlyWhereLaterStepsCountLess) {
  EXPECT_EQ(world_json(*discounted_study(), MdpIndex{0})["may_repeat"], true);
  EXPECT_EQ(world_json(*testing::live_study(), MdpIndex{0})["may_repeat"], false);
}

TEST(EndlessAnswers, AreRightWhereTheRobotNeverArrives) {
  const auto& atlas = *discounted_study()->atlas;
  std::size_t endless = 0;
  for (std::size_t i = 0; i < atlas.num_states(); ++i) {
    const StartIndex start{i};
    const auto path = atlas.trajectory(start);
    if (!path.repeats_from) {
      EXPECT_FALSE(judged_path(atlas, start, numbers_of(path), true).is_legal);
      continue;
    }
    ++endless;
    for (const std::size_t more : {0U, 1U, 3U}) {  // who goes round once more says the same
      const auto longer = written_out(path, path.actions.size() + more);
      if (longer.actions.size() > atlas.domain().max_steps()) continue;
      const auto judged = judged_path(atlas, start, numbers_of(longer), true);
      ASSERT_TRUE(judged.is_legal && judged.is_finished);
      EXPECT_EQ(judged.counts, atlas.feature_counts(start));
      EXPECT_FALSE(first_difference(judged.path, path));
    }
    const auto stops = judged_path(atlas, start, numbers_of(path));
    EXPECT_TRUE(stops.is_legal);
    EXPECT_FALSE(stops.is_finished);
    EXPECT_EQ(stops.counts, std::nullopt);
    auto too_short = numbers_of(path);
    too_short.pop_back();
    EXPECT_FALSE(judged_path(atlas, start, too_short, true).is_legal);
  }
  EXPECT_GE(endless, 1000U);
}

// Any walk that meets itself, followed for ever, counts as a geometric series does, and is never better than the robot.
TEST(EndlessAnswers, CountTheCycleAsOftenAsItIsGoneRound) {
  for (const double discount : testing::kDiscounts) {
    const Atlas atlas{testing::discounted_domain("item-delivery", discount)};
    auto random = RandomStream{5}.split("walks");
    for (int walk = 0; walk < 300; ++walk) {
      const StartIndex start_index{uniform_index(atlas.num_states(), random)};
      const auto [world, start] = atlas.id(start_index);
      const auto& mdp = atlas.domain().mdp(world);
      std::vector<std::size_t> actions;
      std::set<StateIndex> met;
      auto at = start;
      while (!mdp.is_terminal(at) && met.insert(at).second) {
        const auto choices = mdp.choices(at);
        const auto& choice = choices[uniform_index(choices.size(), random)];
        actions.push_back(choice.action.value());
        at = mdp.outcomes(choice).front().next;
      }
      if (mdp.is_terminal(at) || actions.size() > atlas.domain().max_steps()) continue;
      const auto judged = judged_path(atlas, start_index, actions, true);
      ASSERT_TRUE(judged.is_finished && judged.counts);
      const auto features = testing::path_features(mdp, judged.path);
      for (std::size_t k = 0; k < features.size(); ++k) {
        const auto scale = static_cast<double>(atlas.domain().count_scale());
        EXPECT_NEAR(static_cast<double>((*judged.counts)[k]) / scale, features[k], 1e-6);
      }
      EXPECT_LE(return_of(atlas, *judged.counts), return_of(atlas, atlas.feature_counts(start_index)) + 1e-6);
    }
  }
}

// Round the last loop, not the first one.
TEST(EndlessAnswers, GoOnFromTheLastTimeInTheSameState) {
  const auto& atlas = *discounted_study()->atlas;
  const StartIndex start_index{0};
  const auto [world, start] = atlas.id(start_index);
  const auto& mdp = atlas.domain().mdp(world);
  // There and back by every action that can be undone.
  std::vector<std::size_t> actions;
  for (const auto& choice : mdp.choices(start)) {
    const auto next = mdp.outcomes(choice).front().next;
    if (mdp.is_terminal(next)) continue;
    for (const auto& back : mdp.choices(next)) {
      if (mdp.outcomes(back).front().next != start) continue;
      actions.insert(actions.end(), {choice.action.value(), back.action.value()});
    }
  }
  ASSERT_GE(actions.size(), 4U);
  EXPECT_EQ(judged_path(atlas, start_index, actions, true).path.repeats_from, actions.size() - 2);
}

TEST(EndlessAnswers, StopShortOfTheEndWithoutADiscount) {
  const auto& atlas = *testing::live_study()->atlas;
  const StartIndex start_index{0};
  const auto [world, start] = atlas.id(start_index);
  const auto& mdp = atlas.domain().mdp(world);
  std::vector<std::size_t> round;
  for (const auto& choice : mdp.choices(start)) {
    const auto next = mdp.outcomes(choice).front().next;
    if (mdp.is_terminal(next) || !round.empty()) continue;
    for (const auto& back : mdp.choices(next)) {
      if (mdp.outcomes(back).front().next == start) round = {choice.action.value(), back.action.value()};
    }
  }
  ASSERT_EQ(round.size(), 2U);
  const auto judged = judged_path(atlas, start_index, round, true);
  EXPECT_TRUE(judged.is_legal);
  EXPECT_FALSE(judged.is_finished);
  EXPECT_EQ(judged.counts, std::nullopt);
}

// A whole session about a robot that often never arrives: people who say so are right, pages say it too.
TEST(EndlessAnswers, AreGivenAndShownInASession) {
  const auto study = study_at(0.7, "[group]\nscreening = { tests = 4 }\n");
  Play play{study, "NN"};
  play.start(2);
  std::size_t asked = 0, shown = 0;
  for (int i = 0; i < 400 && play.room().stage() == RoomStage::kRunning; ++i) {
    for (const std::size_t seat : {1U, 2U}) {
      const auto page = testing::page(play, seat);
      if (page["stage"] == "watch" && page["watch"].contains("repeats_from")) {
        ++shown;
        const auto& frames = page["watch"]["frames"];
        auto first = frames[page["watch"]["repeats_from"].get<std::size_t>()], last = frames.back();
        for (const char* step : {"action", "counts"}) {
          first.erase(step);
          last.erase(step);
        }
        EXPECT_EQ(first, last);
      }
      if (page["stage"] == "feedback") {
        for (const auto& test : page["feedback"]["tests"]) {
          EXPECT_EQ(test["right"], true);
          EXPECT_EQ(test["unfinished"], false);
          EXPECT_EQ(test.contains("mine_repeats_from"), test.contains("robot_repeats_from"));
          if (!test.contains("mine_repeats_from")) continue;
          ++asked;
          EXPECT_EQ(test["differs_at"], nullptr);
          EXPECT_NE(test["robot_repeats_text"].get<std::string>().find("never delivers the parcel"), std::string::npos);
        }
      }
      play.act(seat);
    }
  }
  EXPECT_EQ(play.room().stage_of(1), "debrief");
  EXPECT_GE(asked + shown, 1U);
  play.expect_replay();
}

TEST(EndlessAnswers, AreRefusedWhereNoStateOccursTwice) {
  Play play{discounted_study(), "N"};
  play.start(1);
  play.watch(1);
  ASSERT_EQ(play.room().stage_of(1), "predict");
  const Json body{{"test", 0}, {"actions", Json::array()}, {"for_ever", true}, {"ms", 1}};
  EXPECT_EQ(play.seat(1, "answer", body), "illegal-path");
  auto odd = body;
  odd["for_ever"] = 1;
  EXPECT_EQ(play.seat(1, "answer", odd), "bad-body");
}

}  // namespace
}  // namespace kith
