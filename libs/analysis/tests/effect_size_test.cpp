#include "kith/analysis/effect_size.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "kith/analysis/moments.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

std::vector<double> normals(std::size_t n, double mean, std::uint64_t seed) {
  RandomStream random{seed};
  std::vector<double> values(n);
  for (auto& value : values) value = mean + standard_normal(random);
  return values;
}

// Means 2 and 5, pooled variance (2 + 8) / 4 = 2.5; Gamma(2) / (sqrt(2) Gamma(3 / 2)) for four degrees of freedom.
TEST(EffectSize, AHandComputedG) {
  const std::vector<double> a{1, 2, 3};
  const std::vector<double> b{3, 5, 7};
  const double correction = 1.0 / (std::sqrt(2.0) * 0.5 * std::sqrt(std::acos(-1.0)));
  EXPECT_NEAR(*hedges_g(a, b), correction * -3.0 / std::sqrt(2.5), 1e-14);
  EXPECT_NEAR(*hedges_g(b, a), -*hedges_g(a, b), 1e-14);
}

// 1 - 3 / (4 df - 1) is what the correction nears for many degrees of freedom.
TEST(EffectSize, OfManyValuesHasTheApproximateCorrection) {
  const auto many = normals(20'000, 0.0, 1);
  const auto more = normals(20'000, 0.5, 2);
  const double pooled =
      std::sqrt((std::pow(*standard_deviation(many), 2) + std::pow(*standard_deviation(more), 2)) / 2);
  EXPECT_NEAR(*hedges_g(many, more) / ((mean(many) - mean(more)) / pooled), 1.0 - 3.0 / (4.0 * 39'998.0 - 1.0), 1e-10);
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
  EXPECT_EQ(hedges_g(constant, std::vector<double>{1, 1}).reason(), "no spread within the groups");
  EXPECT_EQ(hedges_g({}, constant).reason(), "a group without values");
  EXPECT_EQ(hedges_g(std::vector<double>{1}, std::vector<double>{2, 3}).reason(),
            "fewer than two residual degrees of freedom");
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
