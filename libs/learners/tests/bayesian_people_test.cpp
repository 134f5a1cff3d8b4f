#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kith/core/error.hpp"
#include "kith/learners/learner_model.hpp"

namespace kith {
namespace {

struct Drawn {
  double ability;
  double confirm_gain;
  double correct_gain;
  friend bool operator==(const Drawn&, const Drawn&) = default;
};

Drawn draw(const ParameterValues& values, RandomStream random) {
  const auto traits = bayesian_model().draw(values, random);
  return {traits.at(0), traits.at(1), traits.at(2)};
}

ParameterValues novice() { return ParameterValues{bayesian_model().parameters}; }

ParameterValues proficient() {
  auto values = novice();
  values.set("ability.mean", 0.809);
  values.set("ability.sd", 0.025);
  values.set("confirm_gain", Spread{.half_normal = 0.022, .value = {}});
  values.set("correct_gain", Spread{.half_normal = 0.052, .value = {}});
  return values;
}

TEST(BayesianPeople, KeepTheRulesOfTheirType) {
  for (const auto& values : {novice(), proficient()}) {
    for (std::uint64_t person = 0; person < 20'000; ++person) {
      const auto learner = draw(values, RandomStream{1}.split(person));
      ASSERT_GT(learner.ability, values.real("ability.min"));
      ASSERT_LT(learner.ability, values.real("ability_max"));
      ASSERT_GE(learner.confirm_gain, 0.0);
      ASSERT_LT(learner.confirm_gain, learner.correct_gain);
      ASSERT_LT(learner.correct_gain, values.real("gain_max"));
    }
  }
}

// Mean and standard deviation of n = 20 000 abilities of the proficient, of which the limits cut off
// nothing (8 and 5.6 sigma away); 5 standard errors: 0.025 * 5 / sqrt(n) and that / sqrt(2).
TEST(BayesianPeople, HaveNormalAbilities) {
  constexpr int n = 20'000;
  double sum = 0.0;
  double squares = 0.0;
  for (int person = 0; person < n; ++person) {
    const double x = draw(proficient(), RandomStream{2}.split(static_cast<std::uint64_t>(person))).ability - 0.809;
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / n, 0.0, 8.9e-4);
  EXPECT_NEAR(std::sqrt(squares / n), 0.025, 6.3e-4);
}

// Without rules, gains are half-normal with mean sigma sqrt(2/pi) and standard deviation
// sigma sqrt(1 - 2/pi) = 0.603 sigma; n = 20 000, 5 standard errors: 0.0213 sigma. No gain reaches 0.5 (9 sigma).
TEST(BayesianPeople, HaveHalfNormalGains) {
  auto values = proficient();
  values.set("ordered_gains", false);
  values.set("gain_max", 0.5);
  double confirm = 0.0;
  double correct = 0.0;
  constexpr int n = 20'000;
  for (int person = 0; person < n; ++person) {
    const auto learner = draw(values, RandomStream{3}.split(static_cast<std::uint64_t>(person)));
    confirm += learner.confirm_gain / n;
    correct += learner.correct_gain / n;
  }
  EXPECT_NEAR(confirm / 0.022, std::sqrt(2.0 / std::numbers::pi), 0.0214);
  EXPECT_NEAR(correct / 0.052, std::sqrt(2.0 / std::numbers::pi), 0.0214);
}

TEST(BayesianPeople, HaveFixedValuesAsTheyAre) {
  auto values = novice();
  values.set("ability.sd", 0.0);
  values.set("ability.mean", 0.7);
  values.set("confirm_gain", Spread{.half_normal = {}, .value = 0.03});
  values.set("correct_gain", Spread{.half_normal = {}, .value = 0.06});
  EXPECT_EQ(draw(values, RandomStream{4}), (Drawn{0.7, 0.03, 0.06}));
}

TEST(BayesianPeople, DependOnTheAddressOnly) {
  RandomStream used{5};
  for (int i = 0; i < 17; ++i) (void)used();
  EXPECT_EQ(draw(novice(), used), draw(novice(), RandomStream{5}));
  EXPECT_NE(draw(novice(), RandomStream{6}), draw(novice(), RandomStream{5}));
}

// Two types compared on the same person differ by their parameters, not by luck.
TEST(BayesianPeople, HaveGainsApartFromAbilities) {
  auto narrow = novice();
  narrow.set("ability_max", 0.71);
  for (std::uint64_t person = 0; person < 100; ++person) {
    const auto a = draw(novice(), RandomStream{person});
    const auto b = draw(narrow, RandomStream{person});
    EXPECT_EQ(a.confirm_gain, b.confirm_gain);
    EXPECT_EQ(a.correct_gain, b.correct_gain);
  }
}

// As teacher.assumed_ability, which may be 1 as well.
TEST(BayesianPeople, MayHaveAbilitiesUpToCertainty) {
  auto sure = novice();
  sure.set("ability_max", 1.0);
  sure.set("ability.mean", 1.0);
  sure.set("ability.sd", 0.1);
  for (std::uint64_t person = 0; person < 100; ++person) EXPECT_LT(draw(sure, RandomStream{person}).ability, 1.0);
  EXPECT_THROW(sure.set("ability_max", 1.0000001), Error);
}

TEST(BayesianPeople, AreNotFoundWhereNobodyMeetsTheRules) {
  auto nobody = novice();
  nobody.set("ability.mean", 0.5);
  nobody.set("ability.sd", 0.0);
  auto equal = novice();
  equal.set("confirm_gain", Spread{.half_normal = {}, .value = 0.03});
  equal.set("correct_gain", Spread{.half_normal = {}, .value = 0.03});
  for (const auto& values : {nobody, equal}) {
    try {
      (void)draw(values, RandomStream{7});
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    }
  }
  equal.set("ordered_gains", false);
  EXPECT_EQ(draw(equal, RandomStream{7}).confirm_gain, 0.03);
}

TEST(BayesianPeople, NeedRoomForAnAbility) {
  auto values = novice();
  EXPECT_FALSE(bayesian_model().check(values).has_value());
  values.set("ability.min", 0.95);
  const auto problem = bayesian_model().check(values);
  ASSERT_TRUE(problem.has_value());
  EXPECT_EQ(problem->where, "ability");
}

}  // namespace
}  // namespace kith
