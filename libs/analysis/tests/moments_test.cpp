#include "kith/analysis/moments.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace kith {
namespace {

TEST(Moments, OfAHandComputedSample) {
  const std::vector<double> values{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
  EXPECT_DOUBLE_EQ(mean(values), 5.0);
  EXPECT_DOUBLE_EQ(standard_deviation(values).value(), 2.138089935299395);  // sqrt(32 / 7)
}

TEST(Moments, OfValuesFarFromZero) {
  EXPECT_DOUBLE_EQ(standard_deviation(std::vector<double>{1e9 + 1, 1e9 + 2, 1e9 + 3}).value(), 1.0);
}

TEST(Moments, OfTooFewValues) {
  EXPECT_FALSE(standard_deviation(std::vector<double>{1.0}));
  EXPECT_THROW((void)mean({}), std::invalid_argument);
}

// Of the mean it is the standard deviation over the square root of n.
TEST(JackknifeError, OfAMeanIsItsStandardError) {
  const std::vector<double> values{5.0, 7.0, 8.0, 12.0};
  std::vector<double> without;
  for (const double value : values) without.push_back((32.0 - value) / 3.0);
  EXPECT_DOUBLE_EQ(jackknife_error(without), standard_deviation(values).value() / 2.0);
  EXPECT_THROW((void)jackknife_error({}), std::invalid_argument);
}

TEST(PowerSums, GiveTheVarianceWithoutSomeOfTheValues) {
  PowerSums all, some;
  for (const double value : {2.0, 4.0, 4.0, 9.0, -3.0}) all.add(value);
  for (const double value : {9.0, -3.0}) some.add(value);
  EXPECT_DOUBLE_EQ(all.without(some).mean(), 10.0 / 3.0);
  EXPECT_NEAR(all.without(some).variance(), 4.0 / 3.0, 1e-12);
  EXPECT_EQ(PowerSums{}.mean(), 0.0);
  EXPECT_EQ(PowerSums{}.variance(), 0.0);
}

}  // namespace
}  // namespace kith
