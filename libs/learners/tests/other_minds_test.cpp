// What tells the people of each model of other minds from those of "bayesian".
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "item_delivery.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/teaching/known_components.hpp"

namespace kith {
namespace {

using testing::item_delivery;

const std::array kStarts{StartIndex{10}, StartIndex{4000}, StartIndex{9000}};

std::unique_ptr<Learner> somebody(const LearnerModel& model,
                                  const std::vector<std::pair<std::string, double>>& settings) {
  ParameterValues values{model.parameters};
  for (const auto& [name, value] : settings) values.set(name, value);
  std::optional<PriorCover> cover;
  const LearnerStart start{.cover = [&](std::size_t num_points) -> const PriorCover& {
                             return cover.emplace(item_delivery().prior_cone(), num_points);
                           },
                           .components = [] { return constraints_of_components(item_delivery()); }};
  const RandomStream random{20240601};
  return model.make(values, model.draw(values, random.split("parameters")), start, random.split("learner"));
}

// Whoever has learned the whole policy, nearly for certain.
void teach_all(Learner& learner, std::size_t periods) {
  learner.begin_component();
  for (std::size_t period = 1; period <= periods; ++period) {
    learner.watch(item_delivery().policy_bec_half_spaces(), period);
    learner.hear_feedback(false, item_delivery().policy_bec_half_spaces(), period);
  }
}

// Where their own parameter is at the value that changes nothing, people are those of "bayesian", bit for bit.
TEST(OtherMinds, AreBayesianWhereNothingIsDifferent) {
  const auto bayesian = somebody(bayesian_model(), {});
  teach_all(*bayesian, 3);
  Behaviours behaviours{item_delivery()};
  const std::vector<std::pair<const LearnerModel*, std::vector<std::pair<std::string, double>>>> same{
      {&slipping_model(), {{"slip", 0.0}, {"guess", 0.0}}},
      {&imitating_model(), {{"reward", 1.0}}},
      {&decaying_model(), {{"half_life", 1e6}}}};
  for (const auto& [model, settings] : same) {
    const auto other = somebody(*model, settings);
    other->see(item_delivery(), std::array{StartIndex{77}});
    teach_all(*other, 3);
    EXPECT_EQ(*other->belief(), *bayesian->belief()) << model->kind;
    for (std::size_t period = 1; period <= 50; ++period) {
      EXPECT_EQ(other->answer(behaviours, kStarts, period).answers,
                bayesian->answer(behaviours, kStarts, period).answers)
          << model->kind;
    }
  }
}

// n = 2000 answers of somebody who knows the robot's way: wrong with probability slip up to 5 standard errors, and
// sometimes a path that is best for nobody.
TEST(OtherMinds, PressAWrongKeyInSpiteOfKnowingBetter) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  const auto learner = somebody(slipping_model(), {{"slip", 0.3}, {"guess", 0.0}, {"ability.mean", 0.9}});
  teach_all(*learner, 8);
  const auto knowing = somebody(bayesian_model(), {{"ability.mean", 0.9}});
  teach_all(*knowing, 8);
  constexpr int n = 2000;
  const StartIndex test{4000};
  const auto right = [&](const Learner& who, std::size_t draw) {
    const auto answer = who.answer(behaviours, std::array{test}, draw).answers.front();
    return judge_path(atlas.domain(), atlas.feature_counts(test), answer.value()).is_right;
  };
  const auto coverage = atlas.tables().coverage_set(test);
  int knew = 0, slipped = 0, by_nobody = 0;
  for (std::size_t draw = 1; draw <= n; ++draw) {
    if (!right(*knowing, draw)) continue;
    ++knew;
    slipped += right(*learner, draw) ? 0 : 1;
    const auto answer = learner->answer(behaviours, std::array{test}, draw).answers.front().value();
    by_nobody += std::find(coverage.begin(), coverage.end(), answer) == coverage.end() ? 1 : 0;
  }
  ASSERT_GT(knew, 1000);
  EXPECT_NEAR(static_cast<double>(slipped) / knew, 0.3, 5.0 * std::sqrt(0.3 * 0.7 / knew));
  EXPECT_GT(by_nobody, 0);
}

TEST(OtherMinds, FindTheRobotsWayByLuck) {
  Behaviours behaviours{item_delivery()};
  const auto learner = somebody(slipping_model(), {{"slip", 0.0}, {"guess", 1.0}});
  for (std::size_t draw = 1; draw <= 50; ++draw) {
    const auto answers = learner->answer(behaviours, kStarts, draw).answers;
    for (std::size_t t = 0; t < kStarts.size(); ++t) {
      const auto& robot = item_delivery().feature_counts(kStarts[t]);
      EXPECT_TRUE(judge_path(item_delivery().domain(), robot, answers[t].value()).is_right);
    }
  }
}

// With a large rationality people take their best path; without any, each of the paths equally often.
TEST(OtherMinds, TakePathsByWhatTheyAreWorth) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  const auto rational = somebody(noisy_rational_model(), {{"rationality", 1000.0}});
  const auto bayesian = somebody(bayesian_model(), {});
  const auto random = somebody(noisy_rational_model(), {{"rationality", 0.0}});
  const StartIndex test{9000};
  const auto coverage = atlas.tables().coverage_set(test);
  std::vector<int> counts(coverage.size(), 0);
  int same = 0;
  constexpr int n = 1000;
  for (std::size_t draw = 1; draw <= n; ++draw) {
    const auto answer = [&](const Learner& who) { return who.answer(behaviours, std::array{test}, draw).answers[0]; };
    same += answer(*rational) == answer(*bayesian) ? 1 : 0;
    ++counts[static_cast<std::size_t>(std::find(coverage.begin(), coverage.end(), answer(*random)) - coverage.begin())];
  }
  EXPECT_GT(same, n * 9 / 10);
  const double share = 1.0 / static_cast<double>(coverage.size());
  for (const int count : counts) EXPECT_NEAR(count / double{n}, share, 5.0 * std::sqrt(share * (1.0 - share) / n));
}

// Who has seen the very start of the test, and cares for nothing else, does what the robot did, without having learned
// anything; who has seen another start presses the same keys.
TEST(OtherMinds, ImitateWhatTheyHaveSeen) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  const auto learner = somebody(imitating_model(), {{"reward", 0.0}, {"temperature", 0.01}});
  learner->see(atlas, kStarts);
  for (std::size_t draw = 1; draw <= 20; ++draw) {
    const auto answers = learner->answer(behaviours, kStarts, draw).answers;
    for (std::size_t t = 0; t < kStarts.size(); ++t) EXPECT_EQ(answers[t], atlas.feature_counts(kStarts[t]));
  }
}

// More than half of people's belief is false at the start, of somebody without a misconception less than that; enough
// lessons let them recover.
TEST(OtherMinds, RecoverFromAMisconception) {
  const auto constraint = constraints_of_components(item_delivery()).back().front();
  const auto learner = somebody(misconceived_model(), {{"doubt", 0.05}});
  EXPECT_NEAR(learner->mass_in(std::array{constraint}), 0.05, 1e-9);
  teach_all(*learner, 8);
  EXPECT_GT(learner->mass_in(std::array{constraint}), 0.9);
}

// After one half-life, half of what is believed is what was believed at the start.
TEST(OtherMinds, ForgetByHalfLives) {
  const auto& bec = item_delivery().policy_bec_half_spaces();
  const auto learner = somebody(decaying_model(), {{"half_life", 12.0}});
  const double start = learner->mass_in(bec);
  teach_all(*learner, 6);
  const double taught = learner->mass_in(bec);
  ASSERT_GT(taught, 2.0 * start);
  learner->let_time_pass(12.0, 7);
  EXPECT_NEAR(learner->mass_in(bec), (taught + start) / 2.0, 0.02);
}

TEST(OtherMinds, NeedPathsWhereAnswersAreNotBestPaths) {
  const AnswerEvidence regions{{}, std::array{AnswerRegion{{HalfSpace{IntegerVector{1, 0, 0}}}}}, 0.5};
  for (const auto* model : learner_models()) {
    const auto learner = somebody(*model, {});
    if (model->needs_paths) {
      EXPECT_EQ(learner->answers_as_believed(), false);
      if (model == &imitating_model()) learner->see(item_delivery(), std::array{StartIndex{5}});
      EXPECT_THROW((void)learner->likelihood(regions), std::invalid_argument) << model->kind;
    } else {
      EXPECT_TRUE(learner->likelihood(regions).has_value()) << model->kind;
    }
  }
}

}  // namespace
}  // namespace kith
