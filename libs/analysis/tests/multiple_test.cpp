#include "kith/analysis/multiple.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "common.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

using testing::kInfinity;

TEST(Adjust, HolmIsNeverAboveBonferroniNorBelowTheRawValue) {
  const std::vector<double> p{0.01, 0.04, 0.03, 0.005, 0.9, 0.01};
  const auto holm = adjust(p, Correction::kHolm);
  const auto bonferroni = adjust(p, Correction::kBonferroni);
  EXPECT_EQ(adjust(p, Correction::kNone), p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_LE(p[i], holm[i]);
    EXPECT_LE(holm[i], bonferroni[i]);
    EXPECT_LE(bonferroni[i], 1.0);
  }
}

TEST(Adjust, AHandComputedHolm) {
  EXPECT_THAT(adjust(std::vector<double>{0.01, 0.04, 0.03}, Correction::kHolm),
              ::testing::Pointwise(::testing::DoubleEq(), {0.03, 0.06, 0.06}));
  EXPECT_TRUE(adjust({}, Correction::kHolm).empty());
  EXPECT_THROW((void)adjust(std::vector<double>{1.1}, Correction::kHolm), std::invalid_argument);
  EXPECT_THROW((void)adjust(std::vector<double>{std::nan("")}, Correction::kNone), std::invalid_argument);
}

// The example of section 3.2: the largest p of rank i with p <= 0.05 i / 15 is the fourth.
TEST(Adjust, FalseDiscoveryRateOfBenjaminiAndHochbergsExample) {
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const auto adjusted = adjust(p, Correction::kFdr);
  EXPECT_NEAR(adjusted[3], 0.0095 * 15.0 / 4.0, 1e-15);
  EXPECT_LE(adjusted[3], 0.05);
  EXPECT_GT(adjusted[4], 0.05);
  EXPECT_NEAR(adjusted[5], 0.0298 * 15.0 / 7.0, 1e-15);  // as that of the next: adjusted values do not fall
  EXPECT_EQ(adjusted[14], 1.0);
}

TEST(Adjust, CorrectionsHaveNames) {
  EXPECT_EQ(to_string(Correction::kFdr), "Benjamini-Hochberg");
  EXPECT_EQ(to_string(Correction::kNone), "none");
  EXPECT_EQ(to_string(Correction::kBonferroni), "Bonferroni");
  EXPECT_EQ(to_string(Correction::kHolm), "Holm");
}

// The range of two means is sqrt(2) |t|: an exact value for every q, tails included.
TEST(StudentizedRange, OfTwoGroupsIsStudentsT) {
  for (const double df : {2.0, 3.0, 10.0, 224.0, 19984.0, kInfinity}) {
    for (const double q : {1e-3, 0.1, 1.0, 3.0, 6.0, 12.0, 20.0, 30.0}) {
      const double expected = student_t_two_sided(q / std::sqrt(2.0), df);
      EXPECT_NEAR(studentized_range_upper(q, 2, df), expected, 1e-11 * expected) << q << ' ' << df;
    }
  }
}

// q(0.95; 3, 10) and others from the tables in textbooks, which have three digits.
TEST(StudentizedRange, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(studentized_range_quantile(0.05, 3, 10), 3.877, 6e-4);
  EXPECT_NEAR(studentized_range_quantile(0.05, 4, 20), 3.958, 6e-4);
  EXPECT_NEAR(studentized_range_quantile(0.01, 5, 30), 5.048, 6e-4);
  EXPECT_NEAR(studentized_range_quantile(0.05, 10, kInfinity), 4.474, 6e-4);
}

TEST(StudentizedRange, QuantileInvertsTheTail) {
  for (const std::size_t groups : {2u, 4u, 30u}) {
    for (const double df : {2.0, 15.0, 1e5}) {
      for (const double p : {1e-12, 1e-3, 0.05, 0.5, 0.999}) {
        const double q = studentized_range_quantile(p, groups, df);
        EXPECT_NEAR(studentized_range_upper(q, groups, df), p, 1e-10 * p);
      }
    }
  }
}

TEST(StudentizedRange, FallsWithQAndGrowsWithGroups) {
  double before = 1.0;
  for (double q = 0.25; q < 40.0; q *= 1.3) {
    const double upper = studentized_range_upper(q, 4, 56);
    EXPECT_LT(upper, before);
    EXPECT_GT(upper, studentized_range_upper(q, 3, 56));
    before = upper;
  }
  EXPECT_GT(before, 0.0);
}

TEST(StudentizedRange, EndsAreExact) {
  EXPECT_EQ(studentized_range_upper(0.0, 4, 56), 1.0);
  EXPECT_EQ(studentized_range_upper(kInfinity, 4, 56), 0.0);
  EXPECT_EQ(studentized_range_upper(1e300, 4, 1e6), 0.0);
  EXPECT_EQ(studentized_range_upper(100.0, 4, kInfinity), 0.0);
  EXPECT_THROW((void)studentized_range_upper(-1.0, 4, 56), std::invalid_argument);
  EXPECT_THROW((void)studentized_range_upper(1.0, 1, 56), std::invalid_argument);
  EXPECT_THROW((void)studentized_range_upper(1.0, 4, 1.9), std::invalid_argument);
  EXPECT_THROW((void)studentized_range_quantile(0.0, 4, 56), std::invalid_argument);
}

}  // namespace
}  // namespace kith
