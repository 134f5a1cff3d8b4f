#include "kith/stats/effect_size.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "common.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

using testing::kCrossed;

std::vector<double> normals(std::size_t n, double mean, std::uint64_t seed) {
  RandomStream random{seed};
  std::vector<double> values(n);
  for (auto& value : values) value = mean + standard_normal(random);
  return values;
}

// Two factors of two levels, `per_cell` normal values in each cell, `effect` of the first factor.
struct TwoByTwo {
  std::vector<Factor> factors{{"a", {"0", "1"}, {}}, {"b", {"0", "1"}, {}}};
  std::vector<double> response;
};
TwoByTwo two_by_two(std::size_t per_cell, double effect, std::uint64_t seed) {
  TwoByTwo design;
  design.response = normals(4 * per_cell, 0.0, seed);
  for (std::size_t i = 0; i < design.response.size(); ++i) {
    const auto a = i % 2;
    design.factors[0].codes.push_back(a);
    design.factors[1].codes.push_back(i / 2 % 2);
    design.response[i] += effect * static_cast<double>(a);
  }
  return design;
}

// Means 2 and 5, pooled variance (2 + 8) / 4 = 2.5.
TEST(EffectSize, AHandComputedD) {
  const std::vector<double> a{1, 2, 3};
  const std::vector<double> b{3, 5, 7};
  EXPECT_NEAR(*cohens_d(a, b), -3.0 / std::sqrt(2.5), 1e-14);
  EXPECT_NEAR(*cohens_d(b, a), -*cohens_d(a, b), 1e-14);
}

// Gamma(2) / (sqrt(2) Gamma(3 / 2)) for four degrees of freedom; 1 - 3 / (4 df - 1) is its approximation for many.
TEST(EffectSize, HedgesCorrectionIsTheRatioOfGammaFunctions) {
  const std::vector<double> a{1, 2, 3};
  const std::vector<double> b{3, 5, 7};
  EXPECT_NEAR(*hedges_g(a, b) / *cohens_d(a, b), 1.0 / (std::sqrt(2.0) * 0.5 * std::sqrt(std::acos(-1.0))), 1e-14);
  const auto many = normals(20'000, 0.0, 1);
  const auto more = normals(20'000, 0.5, 2);
  EXPECT_NEAR(*hedges_g(many, more) / *cohens_d(many, more), 1.0 - 3.0 / (4.0 * 39'998.0 - 1.0), 1e-10);
}

TEST(EffectSize, DoesNotDependOnScale) {
  const auto a = normals(9, 0.0, 3);
  const auto b = normals(12, 1.0, 4);
  for (const double scale : {1e-200, 1e200}) {
    auto scaled_a = a;
    auto scaled_b = b;
    for (auto& value : scaled_a) value *= scale;
    for (auto& value : scaled_b) value *= scale;
    EXPECT_NEAR(*hedges_g(scaled_a, scaled_b), *hedges_g(a, b), 1e-12);
  }
}

TEST(EffectSize, SaysWhyThereIsNone) {
  const std::vector<double> constant{2, 2};
  EXPECT_EQ(cohens_d(constant, std::vector<double>{1, 1}).reason(), "no spread within the groups");
  EXPECT_EQ(cohens_d({}, constant).reason(), "a group without values");
  EXPECT_THAT(cohens_d(std::vector<double>{1}, std::vector<double>{2}).reason(),
              ::testing::HasSubstr("no residual degrees of freedom"));
  EXPECT_EQ(hedges_g(std::vector<double>{1}, std::vector<double>{2, 3}).reason(),
            "fewer than two residual degrees of freedom");
  // One resample in four has no spread.
  EXPECT_THAT(bootstrap_hedges_g(std::vector<double>{1, 2}, std::vector<double>{5, 6}, {}, RandomStream{1}).reason(),
              ::testing::HasSubstr("too few different values"));
}

TEST(Bootstrap, IsAFunctionOfItsStream) {
  const auto design = two_by_two(6, 1.0, 5);
  const auto run = [&](std::uint64_t seed) {
    return bootstrap_partial_eta_squared(design.response, design.factors, kCrossed, SumsOfSquares::kTypeII, {200, 0.9},
                                         RandomStream{seed})
        .at(0)
        ->high;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

// Every estimate, and the exact distribution of resamples of two values: means 0, 1/2, 1 with weights 1/4, 1/2, 1/4.
TEST(Bootstrap, OfTwoValuesHasTheirRange) {
  const auto interval = bootstrap_mean(std::vector<double>{0, 1}, {1000, 0.4}, RandomStream{3});
  EXPECT_DOUBLE_EQ(interval->estimate, 0.5);
  EXPECT_DOUBLE_EQ(interval->low, 0.5);
  EXPECT_DOUBLE_EQ(interval->high, 0.5);
  const auto wide = bootstrap_mean(std::vector<double>{0, 1}, {1000, 0.6}, RandomStream{3});
  EXPECT_DOUBLE_EQ(wide->low, 0.0);
  EXPECT_DOUBLE_EQ(wide->high, 1.0);
}

// Of 40 values a percentile interval covers a little less than 95 %; four standard errors of 600 samples are 0.04.
TEST(Bootstrap, IntervalOfTheMeanCoversAtItsRate) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const auto interval = bootstrap_mean(normals(40, 2.0, seed), {300, 0.95}, RandomStream{seed}.split("bootstrap"));
    covered += interval->low <= 2.0 && 2.0 <= interval->high ? 1 : 0;
  }
  EXPECT_NEAR(covered / 600.0, 0.94, 0.04);
}

// The population's d is 1.
TEST(Bootstrap, IntervalOfHedgesGCoversAtItsRate) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const auto a = normals(30, 1.0, 2 * seed);
    const auto b = normals(30, 0.0, 2 * seed + 1);
    const auto interval = bootstrap_hedges_g(a, b, {300, 0.9}, RandomStream{seed}.split("bootstrap"));
    EXPECT_EQ(interval->estimate, *hedges_g(a, b));
    covered += interval->low <= 1.0 && 1.0 <= interval->high ? 1 : 0;
  }
  EXPECT_NEAR(covered / 300.0, 0.9, 4 * 0.0173);
}

// The effect 1 of a factor of two levels with noise 1 has eta squared (1/4) / (1/4 + 1) = 0.2.
TEST(Bootstrap, IntervalOfPartialEtaSquaredCoversAtItsRate) {
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto design = two_by_two(40, 1.0, 7000 + seed);
    const auto intervals = bootstrap_partial_eta_squared(design.response, design.factors, kCrossed,
                                                         SumsOfSquares::kTypeII, {200, 0.9}, RandomStream{seed});
    covered += intervals.at(0)->low <= 0.2 && 0.2 <= intervals.at(0)->high ? 1 : 0;
  }
  EXPECT_NEAR(covered / 200.0, 0.9, 4 * 0.0212);
}

// The other factor and the interaction have none.
TEST(Bootstrap, IntervalsOfSmallEffectsHoldTheEstimate) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto design = two_by_two(10, 0.0, 9000 + seed);
    for (const auto& interval : bootstrap_partial_eta_squared(
             design.response, design.factors, kCrossed, SumsOfSquares::kTypeII, {200, 0.95}, RandomStream{seed})) {
      EXPECT_LE(interval->low, interval->estimate);
      EXPECT_GE(interval->high, interval->estimate);
    }
  }
}

TEST(Bootstrap, EstimatesAreThoseOfTheTableAndLieWithinTheResamples) {
  const auto design = two_by_two(10, 2.0, 8);
  for (const auto type : {SumsOfSquares::kTypeII, SumsOfSquares::kTypeIII}) {
    const auto table = anova(design.response, design.factors, kCrossed, type);
    const auto intervals =
        bootstrap_partial_eta_squared(design.response, design.factors, kCrossed, type, {500, 0.99}, RandomStream{1});
    ASSERT_EQ(intervals.size(), 3u);
    for (std::size_t t = 0; t < 3; ++t) {
      EXPECT_EQ(intervals[t]->estimate, *table.terms[t].partial_eta_squared);
      EXPECT_LT(intervals[t]->low, intervals[t]->high);
      EXPECT_GE(intervals[t]->low, 0.0);
      EXPECT_LE(intervals[t]->high, 1.0);
    }
  }
}

TEST(Bootstrap, TermsThatCannotBeEstimatedSayWhy) {
  auto design = two_by_two(3, 1.0, 9);
  design.response.assign(design.response.size(), 4.0);
  const auto intervals = bootstrap_partial_eta_squared(design.response, design.factors, kCrossed,
                                                       SumsOfSquares::kTypeII, {}, RandomStream{1});
  EXPECT_EQ(intervals.at(2).reason(), "no spread within the cells");
  EXPECT_EQ(bootstrap_mean({}, {}, RandomStream{1}).reason(), "no values");
  EXPECT_THROW((void)bootstrap_mean(design.response, {0, 0.95}, RandomStream{1}), std::invalid_argument);
  EXPECT_THROW((void)bootstrap_mean(design.response, {10, 1.0}, RandomStream{1}), std::invalid_argument);
}

// Mean 3, standard error 1 / sqrt(3), t(0.975; 2) = 4.302653.
TEST(MeanInterval, AHandComputedInterval) {
  const auto interval = mean_interval(std::vector<double>{2, 3, 4});
  EXPECT_DOUBLE_EQ(interval->estimate, 3.0);
  EXPECT_NEAR(interval->high, 3.0 + 4.302652729696 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(interval->low + interval->high, 6.0, 1e-12);
  EXPECT_EQ(mean_interval(std::vector<double>{2}).reason(), "fewer than two values");
  EXPECT_EQ(mean_interval(std::vector<double>{0.1, 0.1, 0.1})->low, 0.1);
}

// R: prop.test(9, 12, correct = FALSE) and prop.test(0, 10, correct = FALSE).
TEST(Wilson, EqualsPropTestOfR) {
  const auto some = wilson_interval(9, 12);
  EXPECT_DOUBLE_EQ(some.estimate, 0.75);
  EXPECT_NEAR(some.low, 0.467694665066434, 1e-12);
  EXPECT_NEAR(some.high, 0.911058331605945, 1e-12);
  const auto none = wilson_interval(0, 10);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.277532799862889, 1e-12);
  EXPECT_EQ(wilson_interval(10, 10).high, 1.0);
  EXPECT_NEAR(wilson_interval(10, 10).low, 1.0 - none.high, 1e-15);
}

TEST(Wilson, RefusesMoreSuccessesThanTrials) {
  EXPECT_THROW((void)wilson_interval(2, 1), std::invalid_argument);
  EXPECT_THROW((void)wilson_interval(0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
