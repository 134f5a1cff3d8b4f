#pragma once

#include <cstddef>
#include <span>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/tests.hpp"

namespace kith {

/// Hedges' g: (mean(a) - mean(b)) / pooled standard deviation, times the exact small-sample correction by gamma
/// functions [hedges1981]. Not estimable below two residual degrees of freedom or without spread within the groups.
[[nodiscard]] Estimable<double> hedges_g(std::span<const double> a, std::span<const double> b);
/// The mean with the interval of Student's t. Not estimable below two values.
[[nodiscard]] Estimable<Interval> mean_interval(std::span<const double> values, double confidence = 0.95);
/// A proportion with Wilson's score interval. @throws std::invalid_argument unless successes <= trials, trials > 0.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

// Intervals of effect sizes from the same distribution as the p-value of their test: the effects that the test would
// not reject. They need no resampling and therefore hold for few observations, as far as the test does.

/// Partial eta squared of an F test with the interval that its non-central distribution gives. The limits of the
/// non-centrality L, those at which F is a quantile of the non-central F, become L / (L + df1 + df2 + 1).
///
/// With confidence 1 - 2 alpha the lower limit is above 0 exactly if p < alpha; eta squared is never negative,
/// so that is the interval which belongs to a test at level alpha.
/// @return estimate F df1 / (F df1 + df2) and limits, all in [0, 1].
/// @throws std::invalid_argument unless f is >= 0 and finite, df1 and df2 > 0 and finite, confidence is in (0, 1).
[[nodiscard]] Interval partial_eta_squared_interval(double f, double df1, double df2, double confidence);

/// A standardised difference with its interval from a t test: the limits of the non-centrality of t, times
/// `estimate / t` (the standard error divided by what standardises). It excludes 0 exactly if the two-sided
/// p < 1 - confidence. @param unit  standard error of the difference over the standard deviation that standardises, >
/// 0.
/// @throws std::invalid_argument unless t is finite, df > 0, unit > 0 and finite, confidence is in (0, 1).
[[nodiscard]] Interval standardized_interval(double t, double df, double unit, double confidence);

}  // namespace kith
