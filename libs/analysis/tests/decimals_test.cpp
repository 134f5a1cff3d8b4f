#include "kith/analysis/decimals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

TEST(Decimals, AreAsManyAsAnIntervalNeeds) {
  EXPECT_EQ(interval_text(0.21, 0.43, 2), "[0.21, 0.43]");
  EXPECT_EQ(interval_text(0.0013, 0.0054, 2), "[0.001, 0.005]");
  EXPECT_EQ(interval_text(-0.004, 0.004, 2), "[-0.004, 0.004]");
  EXPECT_EQ(interval_text(-0.0004, 0.2, 2), "[0.00, 0.20]");
  EXPECT_EQ(interval_text(0.5, 0.5, 2), "[0.50, 0.50]");
  EXPECT_EQ(fixed_text(-0.001, 2), "0.00");
}

TEST(Decimals, AreAsManyAsSharesNeed) {
  EXPECT_EQ(share_decimals(std::array{0.5, 1.0, 0.0}, 2), 2);
  EXPECT_EQ(share_decimals(std::array{0.997}, 2), 3);
  EXPECT_EQ(share_decimals(std::array{0.0004}, 2), 4);
  EXPECT_EQ(share_decimals(std::array{0.994, 0.991}, 2), 3);
}

// Two ends that differ read so, and 0 is in what is printed exactly if it is in the interval.
TEST(Decimals, KeepWhatIntervalsSay) {
  RandomStream random{7};
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10.0, 1.0 - 4.0 * uniform01(random));
    const double low = size * standard_normal(random), high = low + size * uniform01(random) + 1e-6;
    const int decimals = interval_decimals(low, high, 2);
    const double from = std::stod(fixed_text(low, decimals)), to = std::stod(fixed_text(high, decimals));
    EXPECT_LT(from, to) << low << " " << high;
    EXPECT_EQ(from <= 0.0 && to >= 0.0, low <= 0.0 && high >= 0.0) << low << " " << high;
  }
}

}  // namespace
}  // namespace kith
