#include "kith/learners/population.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "kith/core/error.hpp"

namespace kith {
namespace {

Population proficient() {
  Population population;
  population.label = "proficient";
  population.ability_mean = 0.809;
  population.ability_sd = 0.025;
  population.confirm_gain = {.half_normal = 0.022, .value = {}};
  population.correct_gain = {.half_normal = 0.052, .value = {}};
  return population;
}

TEST(DrawLearner, KeepsTheRulesOfThePopulation) {
  for (const Population& population : {Population{}, proficient()}) {
    for (std::uint64_t person = 0; person < 20'000; ++person) {
      const auto learner = draw_learner(population, RandomStream{1}.split(person));
      ASSERT_GT(learner.ability, population.ability_min);
      ASSERT_LT(learner.ability, population.ability_max);
      ASSERT_GE(learner.confirm_gain, 0.0);
      ASSERT_LT(learner.confirm_gain, learner.correct_gain);
      ASSERT_LT(learner.correct_gain, population.gain_max);
      ASSERT_EQ(learner.ability_max, population.ability_max);
    }
  }
}

// Mean and standard deviation of n = 20 000 abilities of the proficient, of which the limits cut off
// nothing (8 and 5.6 sigma away); 5 standard errors: 0.025 * 5 / sqrt(n) and that / sqrt(2).
TEST(DrawLearner, DrawsNormalAbilities) {
  constexpr int n = 20'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int person = 0; person < n; ++person) {
    const double x =
        draw_learner(proficient(), RandomStream{2}.split(static_cast<std::uint64_t>(person))).ability - 0.809;
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / n, 0.0, 8.9e-4);
  EXPECT_NEAR(std::sqrt(squares / n), 0.025, 6.3e-4);
}

// Without rules, gains are half-normal with mean sigma sqrt(2/pi) and standard deviation
// sigma sqrt(1 - 2/pi) = 0.603 sigma; n = 20 000, 5 standard errors: 0.0213 sigma.
TEST(DrawLearner, DrawsHalfNormalGains) {
  Population population = proficient();
  population.ordered_gains = false;
  population.gain_max = 10.0;
  double confirm = 0.0;
  double correct = 0.0;
  constexpr int n = 20'000;
  for (int person = 0; person < n; ++person) {
    const auto learner = draw_learner(population, RandomStream{3}.split(static_cast<std::uint64_t>(person)));
    confirm += learner.confirm_gain / n;
    correct += learner.correct_gain / n;
  }
  EXPECT_NEAR(confirm / 0.022, std::sqrt(2.0 / std::numbers::pi), 0.0214);
  EXPECT_NEAR(correct / 0.052, std::sqrt(2.0 / std::numbers::pi), 0.0214);
}

TEST(DrawLearner, TakesFixedValuesAsTheyAre) {
  Population population;
  population.ability_sd = 0.0;
  population.ability_mean = 0.7;
  population.confirm_gain = {.half_normal = {}, .value = 0.03};
  population.correct_gain = {.half_normal = {}, .value = 0.06};
  population.ability_scale = 0.9;
  EXPECT_EQ(
      draw_learner(population, RandomStream{4}),
      (LearnerParameters{
          .ability = 0.7, .confirm_gain = 0.03, .correct_gain = 0.06, .ability_max = 0.95, .ability_scale = 0.9}));
}

TEST(DrawLearner, DependsOnTheAddressOnly) {
  RandomStream used{5};
  for (int i = 0; i < 17; ++i) (void)used();
  EXPECT_EQ(draw_learner(Population{}, used), draw_learner(Population{}, RandomStream{5}));
  EXPECT_NE(draw_learner(Population{}, RandomStream{6}), draw_learner(Population{}, RandomStream{5}));
}

// Two types compared on the same person differ by their parameters, not by luck.
TEST(DrawLearner, DrawsGainsApartFromAbilities) {
  Population narrow;
  narrow.ability_max = 0.71;
  for (std::uint64_t person = 0; person < 100; ++person) {
    const auto a = draw_learner(Population{}, RandomStream{person});
    const auto b = draw_learner(narrow, RandomStream{person});
    EXPECT_EQ(a.confirm_gain, b.confirm_gain);
    EXPECT_EQ(a.correct_gain, b.correct_gain);
  }
}

TEST(DrawLearner, SaysWhenNobodyMeetsTheRules) {
  Population nobody;
  nobody.ability_mean = 0.5;
  nobody.ability_sd = 0.0;
  Population equal;
  equal.confirm_gain = equal.correct_gain = {.half_normal = {}, .value = 0.03};
  for (const Population& population : {nobody, equal}) {
    try {
      (void)draw_learner(population, RandomStream{7});
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    }
  }
  equal.ordered_gains = false;
  EXPECT_EQ(draw_learner(equal, RandomStream{7}).confirm_gain, 0.03);
}

TEST(DrawLearner, RefusesNonsense) {
  const std::vector<std::function<void(Population&)>> mistakes{
      [](Population& p) { p.ability_sd = -0.1; },
      [](Population& p) { p.ability_mean = std::nan(""); },
      [](Population& p) { p.ability_min = 0.4; },
      [](Population& p) { p.ability_min = p.ability_max; },
      [](Population& p) { p.ability_max = 1.1; },
      [](Population& p) { p.gain_max = 0.0; },
      [](Population& p) { p.ability_scale = 0.0; },
      [](Population& p) { p.confirm_gain = {}; },
      [](Population& p) { p.correct_gain = {.half_normal = 0.1, .value = 0.1}; },
      [](Population& p) { p.correct_gain = {.half_normal = -0.1, .value = {}}; },
      [](Population& p) { p.confirm_gain = {.half_normal = {}, .value = std::nan("")}; },
  };
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    Population population;
    mistakes[i](population);
    EXPECT_THROW((void)draw_learner(population, RandomStream{8}), std::invalid_argument) << i;
  }
}

}  // namespace
}  // namespace kith
