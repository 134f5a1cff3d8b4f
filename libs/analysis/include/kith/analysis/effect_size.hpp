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

}  // namespace kith
