#pragma once

#include <span>
#include <string>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"

namespace kith {

/// A test statistic with its distribution under the null hypothesis and the p-value.
struct TestResult {
  std::string statistic_name;  ///< "F", "t", "chi-squared", "H"
  double statistic = 0.0;
  std::vector<double> df;  ///< Degrees of freedom, in their usual order.
  double p = 1.0;          ///< In [0, 1].
};

// Values must be finite and every observation must have a level, else std::invalid_argument. Levels without
// observations do not count. Spread that rounding of the values explains is no spread.

/// One-way analysis of variance of k groups and n values, F(k - 1, n - k) (R: aov).
[[nodiscard]] Estimable<TestResult> one_way_anova(std::span<const double> values, const Factor& groups);
/// Welch's test of equal means without equal variances (R: oneway.test(var.equal = FALSE)).
[[nodiscard]] Estimable<TestResult> welch_anova(std::span<const double> values, const Factor& groups);
/// Kruskal-Wallis rank sum test with the correction for ties (R: kruskal.test).
[[nodiscard]] Estimable<TestResult> kruskal_wallis(std::span<const double> values, const Factor& groups);
/// Test of equal variances by absolute deviations from the group medians (Brown and Forsythe).
[[nodiscard]] Estimable<TestResult> brown_forsythe(std::span<const double> values, const Factor& groups);

/// An estimate with its confidence interval.
struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// A difference of means with its confidence interval and two-sided test.
struct MeanDifference {
  double difference = 0.0;  ///< mean(a) - mean(b)
  double standard_error = 0.0;
  double low = 0.0;  ///< Confidence interval at the level asked for.
  double high = 0.0;
  TestResult test;
};
/// Two independent samples without equal variances (R: t.test). @param confidence in (0, 1).
[[nodiscard]] Estimable<MeanDifference> welch_t_test(std::span<const double> a, std::span<const double> b,
                                                     double confidence = 0.95);
/// Pairs, such as teams of the same simulated people under two strategies (R: t.test(paired = TRUE)).
/// @throws std::invalid_argument unless both have the same length.
[[nodiscard]] Estimable<MeanDifference> paired_t_test(std::span<const double> a, std::span<const double> b,
                                                      double confidence = 0.95);

/// The ratio of two variances with its interval and two-sided F test (R: var.test). Both assume normal values; where
/// they are not, brown_forsythe() does without.
struct VarianceRatio {
  Interval ratio;   ///< variance(a) / variance(b)
  TestResult test;  ///< F(a - 1, b - 1)
};
/// Not estimable below two values in a group, or if one has no spread. @param confidence in (0, 1).
[[nodiscard]] Estimable<VarianceRatio> variance_ratio(std::span<const double> a, std::span<const double> b,
                                                      double confidence = 0.95);

/// Ranks from 1; ties get their mean rank.
[[nodiscard]] std::vector<double> mid_ranks(std::span<const double> values);

}  // namespace kith
