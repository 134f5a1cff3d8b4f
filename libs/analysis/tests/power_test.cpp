#include "kith/analysis/power.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace kith {
namespace {

TEST(Power, WithoutEffectIsAlpha) {
  EXPECT_NEAR(f_test_power(0.0, 3, 16, 240, 0.05), 0.05, 1e-12);
  EXPECT_NEAR(f_test_power(0.0, 9, 16, 240, 0.01), 0.01, 1e-12);
}

TEST(Power, GrowsWithEffectObservationsAndAlpha) {
  const double power = f_test_power(0.06, 3, 16, 240, 0.05);
  EXPECT_LT(power, f_test_power(0.07, 3, 16, 240, 0.05));
  EXPECT_LT(power, f_test_power(0.06, 3, 16, 250, 0.05));
  EXPECT_LT(power, f_test_power(0.06, 3, 16, 240, 0.06));
  EXPECT_GT(power, f_test_power(0.06, 9, 16, 240, 0.05));
  EXPECT_NEAR(f_test_power(0.9, 3, 16, 240, 0.05), 1.0, 1e-12);
}

TEST(Power, EtaSquaredOfAPublishedF) {
  EXPECT_DOUBLE_EQ(eta_squared_of_f(4.0, 3.0, 36.0), 0.25);
  EXPECT_EQ(eta_squared_of_f(0.0, 3.0, 36.0), 0.0);
  EXPECT_THROW((void)eta_squared_of_f(-1.0, 3.0, 36.0), std::invalid_argument);
}

TEST(Power, RefusesBrokenPreconditions) {
  EXPECT_THROW((void)f_test_power(1.0, 3, 16, 240, 0.05), std::invalid_argument);
  EXPECT_THROW((void)f_test_power(0.1, 0, 16, 240, 0.05), std::invalid_argument);
  EXPECT_THROW((void)f_test_power(0.1, 3, 16, 16, 0.05), std::invalid_argument);
  EXPECT_THROW((void)f_test_power(0.1, 3, 16, 240, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
