#include "kith/stats/moments.hpp"

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

}  // namespace
}  // namespace kith
