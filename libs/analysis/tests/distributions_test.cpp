#include "kith/analysis/distributions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "common.hpp"

namespace kith {
namespace {

using testing::kInfinity;

void expect_close(double actual, double expected, double relative) {
  EXPECT_NEAR(actual, expected, relative * std::abs(expected));
}

TEST(Distributions, TailsAgreeWithR) {
  expect_close(normal_upper(1.5), 0.066807201268858071, 1e-13);
  expect_close(normal_upper(30), 4.9067139271481872e-198, 1e-12);
  expect_close(student_t_two_sided(-2.3, 7.5), 0.052572896104369021, 1e-13);
  expect_close(f_upper(3, 3, 224), 0.031445755089805363, 1e-13);
  expect_close(f_upper(300, 3, 224), 3.7383560208477323e-78, 1e-12);
  expect_close(chi_squared_upper(12, 3), 0.0073831605053597711, 1e-13);
  expect_close(chi_squared_upper(1200, 3), 7.331671591550679e-260, 1e-12);
}

TEST(Distributions, QuantilesAgreeWithR) {
  expect_close(normal_quantile(0.975), 1.9599639845400536, 1e-13);
  expect_close(student_t_quantile(0.975, 7.5), 2.3330396268649736, 1e-13);
  expect_close(student_t_quantile(1e-4, 2), -70.700071074964271, 1e-12);
  expect_close(f_quantile(0.95, 3, 224), 2.6449025135185997, 1e-12);
}

TEST(Distributions, QuantilesInvertTails) {
  for (const double p : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
    expect_close(normal_upper(-normal_quantile(p)), p, 1e-12);
    for (const double df : {1.0, 2.5, 30.0, 1e5, kInfinity}) {
      expect_close(1.0 - f_upper(f_quantile(p, 3.0, df), 3.0, df), p, 1e-9);
      const double t = student_t_quantile(p, df);
      expect_close(student_t_two_sided(t, df), 2.0 * std::min(p, 1.0 - p), 1e-9);
    }
  }
}

TEST(Distributions, InfiniteDegreesOfFreedomAreTheLimit) {
  expect_close(student_t_two_sided(1.96, kInfinity), 0.049995790296440856, 1e-13);
  expect_close(f_upper(3, 3, kInfinity), 0.029290886534888233, 1e-13);
  expect_close(f_upper(3, kInfinity, 4), 0.1443048016123466, 1e-13);
  expect_close(f_quantile(0.95, 3, kInfinity), 2.6049093010837265, 1e-12);
  expect_close(f_quantile(0.95, kInfinity, 4), 5.6280715265642565, 1e-12);
  EXPECT_EQ(f_upper(2.0, kInfinity, kInfinity), 0.0);
  EXPECT_EQ(f_upper(0.5, kInfinity, kInfinity), 1.0);
}

TEST(Distributions, ExtremeArgumentsNeitherOverflowNorVanishTooEarly) {
  expect_close(student_t_two_sided(1e200, 1.0), 2e-200 / std::numbers::pi, 1e-12);
  EXPECT_EQ(student_t_two_sided(kInfinity, 4.0), 0.0);
  EXPECT_EQ(f_upper(kInfinity, 3.0, 4.0), 0.0);
  EXPECT_EQ(f_upper(0.0, 3.0, 4.0), 1.0);
  EXPECT_EQ(f_upper(1e308, 3.0, 1e6), 0.0);
  EXPECT_EQ(chi_squared_upper(kInfinity, 3.0), 0.0);
}

// R's own pf with ncp stops its series at 1e-9.
TEST(Distributions, NonCentralFAgreesWithR) {
  expect_close(non_central_f_upper(2.645, 3, 224, 0.5), 0.080548523030451444, 1e-8);
  expect_close(non_central_f_upper(2.645, 3, 224, 10), 0.7529421942392448, 1e-8);
  expect_close(non_central_f_upper(1 + 1e6 / 3, 3, 20000, 1e6), 0.50125232842022283, 1e-8);
  expect_close(non_central_f_upper(3, 3, kInfinity, 10), 0.68896280401214394, 1e-12);
}

TEST(Distributions, NonCentralFHasNoLargestNonCentrality) {
  for (const double df2 : {5.0, 200.0, kInfinity}) {
    for (const double non_centrality : {1e10, 1e16, 1e300}) {
      EXPECT_EQ(non_central_f_upper(2.6, 3, df2, non_centrality), 1.0) << df2;
      EXPECT_NEAR(non_central_f_upper(non_centrality * 1e3, 3, df2, non_centrality), 0.0, 1e-6) << df2;
    }
    // Where one way of computing ends and the other begins they agree.
    const double far = 1e9 / 3;
    EXPECT_NEAR(non_central_f_upper(far, 3, df2, 0.999e9), non_central_f_upper(far * 1.002, 3, df2, 1.001e9), 1e-2)
        << df2;
  }
}

TEST(Distributions, NonCentralFWithoutNonCentralityIsF) {
  for (const double f : {0.1, 1.0, 7.0}) {
    EXPECT_EQ(non_central_f_upper(f, 3, 20, 0.0), f_upper(f, 3, 20));
    expect_close(non_central_f_upper(f, 3, 20, 1e-9), f_upper(f, 3, 20), 1e-8);
  }
}

TEST(Distributions, RefuseWhatDefinesNoDistribution) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)f_upper(1, 0, 3), std::invalid_argument);
  EXPECT_THROW((void)f_upper(nan, 1, 3), std::invalid_argument);
  EXPECT_THROW((void)f_upper(1, 1, nan), std::invalid_argument);
  EXPECT_THROW((void)normal_quantile(1.0), std::invalid_argument);
  EXPECT_THROW((void)student_t_quantile(0.0, 3), std::invalid_argument);
  EXPECT_THROW((void)student_t_two_sided(1.0, -1), std::invalid_argument);
  EXPECT_THROW((void)chi_squared_upper(1.0, kInfinity), std::invalid_argument);
  EXPECT_THROW((void)non_central_f_upper(1.0, 2, 3, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
