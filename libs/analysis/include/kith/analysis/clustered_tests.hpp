#pragma once

#include <span>

#include "kith/analysis/tests.hpp"

namespace kith {

// Tests of values that come in blocks or clusters of values that are alike, such as teams of the same people. Values
// must be finite and every observation must have a level, else std::invalid_argument.

/// Friedman's rank sum test of a factor within blocks, with the correction for ties, chi-squared(k - 1) (R:
/// friedman.test). Not estimable unless every block has each level exactly once.
[[nodiscard]] Estimable<TestResult> friedman(std::span<const double> values, const Factor& within,
                                             const Factor& blocks);

/// The variance ratio of two samples whose values come in clusters of values that are alike, such as teams of the same
/// people under several strategies: clusters may be in both samples. Interval and two-sided t test of the logarithm of
/// the ratio, with the standard error of the jackknife that leaves out one cluster at a time and clusters - 1 degrees
/// of freedom. Assumes no distribution. Not estimable below three clusters, or if a sample has no spread.
/// @param sample  two levels; the ratio is the variance of the first over that of the second.
/// @param confidence  in (0, 1).
[[nodiscard]] Estimable<VarianceRatio> clustered_variance_ratio(std::span<const double> values, const Factor& sample,
                                                                const Factor& clusters, double confidence = 0.95);
/// Brown and Forsythe's test of equal spread for such samples: absolute deviations from the medians of the samples,
/// averaged within cluster and sample, compared by the paired t test of the clusters that are in both.
[[nodiscard]] Estimable<TestResult> clustered_brown_forsythe(std::span<const double> values, const Factor& sample,
                                                             const Factor& clusters);

}  // namespace kith
