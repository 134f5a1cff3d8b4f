#include "kith/analysis/effect_size.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

// R 4.2: uniroot() on pf(f, df1, df2, ncp), then L / (L + df1 + df2 + 1).
TEST(PartialEtaSquaredInterval, EqualsThatOfR) {
  struct Case {
    double f, df1, df2, confidence, low, high;
  };
  for (const auto& c : {Case{10.82, 3, 224, 0.9, 0.0586627683, 0.1869241825}, Case{0.245, 3, 224, 0.9, 0, 0.0100326699},
                        Case{27, 2, 6, 0.9, 0.5453880132, 0.9300712500}, Case{4.2, 1, 10, 0.9, 0, 0.5473530563},
                        Case{3.5, 2, 30, 0.95, 0, 0.3861387896}}) {
    const auto interval = partial_eta_squared_interval(c.f, c.df1, c.df2, c.confidence);
    EXPECT_DOUBLE_EQ(interval.estimate, c.f * c.df1 / (c.f * c.df1 + c.df2));
    EXPECT_NEAR(interval.low, c.low, 2e-8) << c.f;
    EXPECT_NEAR(interval.high, c.high, 2e-8) << c.f;
  }
}

// What an interval and a test say must not contradict each other.
TEST(PartialEtaSquaredInterval, ExcludesZeroExactlyWhereTheTestRejects) {
  for (const double df2 : {2.0, 6.0, 60.0, 1e5}) {
    for (const double df1 : {1.0, 3.0, 9.0}) {
      const double critical = f_quantile(0.95, df1, df2);
      EXPECT_GT(partial_eta_squared_interval(1.001 * critical, df1, df2, 0.9).low, 0.0);
      EXPECT_EQ(partial_eta_squared_interval(0.999 * critical, df1, df2, 0.9).low, 0.0);
    }
  }
}

// R 4.2: uniroot() on pt(t, df, ncp).
TEST(StandardizedInterval, EqualsThatOfR) {
  struct Case {
    double t, df, confidence, low, high;
  };
  for (const auto& c :
       {Case{2.5, 12, 0.95, 0.2635132533, 4.6544052049}, Case{-3.207, 4, 0.95, -6.0324413738, -0.2304982465},
        Case{0, 7.5, 0.95, -1.9599639845, 1.9599639845}, Case{0.4, 58, 0.9, -1.2477016766, 2.0442637034}}) {
    const auto interval = standardized_interval(c.t, c.df, 0.5, c.confidence);
    EXPECT_DOUBLE_EQ(interval.estimate, 0.5 * c.t);
    EXPECT_NEAR(interval.low, 0.5 * c.low, 2e-8) << c.t;
    EXPECT_NEAR(interval.high, 0.5 * c.high, 2e-8) << c.t;
  }
}

TEST(StandardizedInterval, ExcludesZeroExactlyWhereTheTestRejects) {
  for (const double df : {1.0, 4.0, 58.0, 1e7}) {
    const double critical = student_t_quantile(0.975, df);
    EXPECT_GT(standardized_interval(1.001 * critical, df, 1.0, 0.95).low, 0.0) << df;
    EXPECT_LT(standardized_interval(0.999 * critical, df, 1.0, 0.95).low, 0.0) << df;
  }
}

TEST(StandardizedInterval, OfHugeStatisticsIsFinite) {
  for (const double t : {299.0, 301.0, -1e6, 1e12}) {
    const auto interval = standardized_interval(t, 30.0, 1.0, 0.95);
    EXPECT_LT(interval.low, t);
    EXPECT_GT(interval.high, t);
    EXPECT_TRUE(std::isfinite(interval.low) && std::isfinite(interval.high));
  }
}

TEST(EffectIntervals, RefuseWhatIsNoTest) {
  EXPECT_THROW((void)partial_eta_squared_interval(-1, 1, 1, 0.9), std::invalid_argument);
  EXPECT_THROW((void)partial_eta_squared_interval(1, 0, 1, 0.9), std::invalid_argument);
  EXPECT_THROW((void)partial_eta_squared_interval(1, 1, 1, 1), std::invalid_argument);
  EXPECT_THROW((void)standardized_interval(std::numeric_limits<double>::quiet_NaN(), 1, 1, 0.9), std::invalid_argument);
  EXPECT_THROW((void)standardized_interval(1, 1, 0, 0.9), std::invalid_argument);
}

}  // namespace
}  // namespace kith
