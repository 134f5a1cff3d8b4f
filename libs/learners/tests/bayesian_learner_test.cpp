#include "kith/learners/bayesian_learner.hpp"

#include <gtest/gtest.h>

#include <array>

#include "item_delivery.hpp"

namespace kith {
namespace {

using testing::half_spaces;
using testing::item_delivery;

BayesianLearner make_learner(const BayesianPerson& parameters, std::uint64_t person = 1) {
  const auto& atlas = item_delivery();
  return {ParticleBelief{atlas.prior_cone(), {}}, parameters, LikelihoodForm::kDiscontinuous, RandomStream{person}};
}

constexpr BayesianPerson kNovice{
    .ability = 0.7, .confirm_gain = 0.02, .correct_gain = 0.05, .ability_max = 0.95, .ability_scale = 1.0};

TEST(BayesianLearner, AbilityGrowsWithFeedbackUpToItsCapAndReturnsWithANewComponent) {
  auto learner = make_learner(kNovice);
  EXPECT_EQ(learner.ability(), 0.7);
  learner.hear_feedback(true, {}, 1);
  EXPECT_DOUBLE_EQ(learner.ability().value(), 0.72);
  learner.hear_feedback(false, {}, 2);
  EXPECT_DOUBLE_EQ(learner.ability().value(), 0.77);
  for (std::size_t period = 3; period < 20; ++period) learner.hear_feedback(false, {}, period);
  EXPECT_EQ(learner.ability(), 0.95);
  learner.begin_component();
  EXPECT_EQ(learner.ability(), 0.7);
}

// A person of capacity 2 learns what they would from the first two constraints alone; feedback does not bring the
// others.
TEST(BayesianLearner, TakesInWhatFitsIntoTheirCapacity) {
  const auto shown = half_spaces({{-1, 0, 2}, {0, -1, -4}, {1, 1, 0}});
  const std::vector<HalfSpace> first(shown.begin(), shown.begin() + 2);
  auto limited = kNovice;
  limited.capacity = 2;
  auto learner = make_learner(limited);
  auto other = make_learner(kNovice);
  for (std::size_t period = 1; period <= 2; ++period) {
    learner.watch(shown, period);
    other.watch(first, period);
    learner.hear_feedback(true, shown, period);
    other.hear_feedback(true, first, period);
    EXPECT_EQ(*learner.belief(), *other.belief());
  }
  limited.beyond_capacity = 1.0;
  auto lucky = make_learner(limited);
  auto unlimited = make_learner(kNovice);
  lucky.watch(shown, 1);
  unlimited.watch(shown, 1);
  EXPECT_EQ(*lucky.belief(), *unlimited.belief());
}

TEST(BayesianLearner, ForgetsBetweenPeriods) {
  const auto& bec = item_delivery().policy_bec_half_spaces();
  auto forgetful = kNovice;
  forgetful.forgetting = 0.3;
  auto learner = make_learner(forgetful);
  auto other = make_learner(kNovice);
  learner.watch(bec, 1);
  other.watch(bec, 1);
  EXPECT_EQ(*learner.belief(), *other.belief());
  learner.watch({}, 2);
  other.watch({}, 2);
  EXPECT_LT(learner.belief()->mass_in(bec), other.belief()->mass_in(bec));
}

TEST(BayesianLearner, SaysHowWellTheyWillLearn) {
  auto person = kNovice;
  person.ability_scale = 0.9;
  auto learner = make_learner(person);
  learner.hear_feedback(false, {}, 1);
  EXPECT_DOUBLE_EQ(learner.learning_abilities(true)->shown, scaled_ability(0.7, 0.9));
  EXPECT_DOUBLE_EQ(learner.learning_abilities(false)->shown, scaled_ability(0.75, 0.9));
  EXPECT_DOUBLE_EQ(learner.learning_abilities(false)->feedback, scaled_ability(0.785, 0.9));
}

TEST(BayesianLearner, LearnsFromDemonstrationsAndFeedback) {
  const auto& bec = item_delivery().policy_bec_half_spaces();
  auto learner = make_learner(kNovice);
  const double before = learner.belief()->mass_in(bec);
  learner.watch(bec, 1);
  const double watched = learner.belief()->mass_in(bec);
  EXPECT_GT(watched, before);
  learner.hear_feedback(false, bec, 1);
  EXPECT_GT(learner.belief()->mass_in(bec), watched);
}

// At ability 0.5 both sides of every constraint are equally likely.
TEST(BayesianLearner, AtAbilityOneHalfNothingIsLearnedFromDemonstrations) {
  auto learner = make_learner(
      {.ability = 0.5, .confirm_gain = 0.0, .correct_gain = 0.0, .ability_max = 0.95, .ability_scale = 1.0});
  const auto before = *learner.belief();
  for (std::size_t period = 1; period <= 10; ++period) learner.watch(item_delivery().policy_bec_half_spaces(), period);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(learner.belief()->weights()[i], before.weights()[i], 1e-15);
  EXPECT_EQ(learner.belief()->num_resamplings(), 0u);
}

TEST(BayesianLearner, AbilityScaleTempersEveryUpdate) {
  const auto& bec = item_delivery().policy_bec_half_spaces();
  auto plain = make_learner(kNovice);
  auto tempered_parameters = kNovice;
  tempered_parameters.ability_scale = 0.5;
  auto tempered = make_learner(tempered_parameters);
  plain.watch(bec, 1);
  tempered.watch(bec, 1);
  EXPECT_GT(plain.belief()->mass_in(bec), tempered.belief()->mass_in(bec));
}

// Somebody who is certain believes one half-space, then its opposite; no weight would be left to them.
TEST(BayesianLearner, CertaintyLeavesEverythingPossible) {
  for (const double scale : {1.0, 5.0}) {
    auto learner = make_learner(
        {.ability = 1.0, .confirm_gain = 0.0, .correct_gain = 0.0, .ability_max = 1.0, .ability_scale = scale});
    for (const HalfSpace& shown : half_spaces({{1, 0, 2}, {-1, 0, -2}, {0, 1, 2}, {0, -1, -2}})) {
      EXPECT_NO_THROW(learner.watch(std::array{shown}, 1));
      EXPECT_NO_THROW(learner.hear_feedback(true, std::array{shown.opposite()}, 1));
    }
    EXPECT_EQ(learner.ability(), 1.0);
  }
}

TEST(BayesianLearner, AnswersAllTestsFromOneWeightThatHasAnOptimumInAllOfThem) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  const auto learner = make_learner(kNovice);
  const std::array tests{StartIndex{10}, StartIndex{4000}, StartIndex{9000}};
  for (std::size_t period = 1; period <= 200; ++period) {
    const auto response = learner.answer(behaviours, tests, period);
    ASSERT_TRUE(response.weights.has_value());
    const auto cell = atlas.tables().cells().locate(*response.weights);
    for (std::size_t t = 0; t < tests.size(); ++t) {
      ASSERT_TRUE(response.answers[t].has_value());
      EXPECT_EQ(response.answers[t], atlas.tables().answer(tests[t], cell));
    }
  }
}

TEST(BayesianLearner, AnswersOfAPeriodDoNotDependOnWhatWasAskedBefore) {
  Behaviours behaviours{item_delivery()};
  const std::array tests{StartIndex{10}, StartIndex{4000}};
  const auto learner = make_learner(kNovice);
  const auto fresh = learner.answer(behaviours, tests, 7);
  (void)learner.answer(behaviours, tests, 3);
  EXPECT_EQ(learner.answer(behaviours, tests, 7).answers, fresh.answers);
  EXPECT_EQ(learner.answer(behaviours, tests, 7).weights, fresh.weights);
}

// Somebody to whom every step is a reward has no plan that ends.
TEST(BayesianLearner, HasNoAnswerWhenNoWeightHasAFiniteOptimum) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  const auto likes_steps = Cone::intersection(half_spaces({{0, 0, 1}}));
  ASSERT_TRUE(likes_steps.has_value());
  const BayesianLearner learner{ParticleBelief{*likes_steps, {}}, kNovice, LikelihoodForm::kDiscontinuous,
                                RandomStream{3}};
  const auto response = learner.answer(behaviours, std::array{StartIndex{0}, StartIndex{1}}, 1);
  EXPECT_FALSE(response.weights.has_value());
  for (const auto& answer : response.answers) EXPECT_FALSE(answer.has_value());
}

TEST(BayesianLearner, WhatIsConveyedToImaginedWeightsHoldsAtTheRobotsWeights) {
  const auto& atlas = item_delivery();
  Behaviours behaviours{atlas};
  Regions regions{behaviours.constraints()};
  const auto learner = make_learner(kNovice);
  const auto conveyed =
      conveyed_to(behaviours, regions, std::array{StartIndex{8000}, StartIndex{9000}}, learner.imagined_weights(8, 1));
  EXPECT_FALSE(conveyed.empty());
  for (const auto& half_space : conveyed) {
    EXPECT_GE(sign_of_dot(half_space.normal(), atlas.domain().weights().integer), 0);
  }
}

}  // namespace
}  // namespace kith
