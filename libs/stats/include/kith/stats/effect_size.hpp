#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kith/random/stream.hpp"
#include "kith/stats/anova.hpp"
#include "kith/stats/estimable.hpp"

namespace kith {

/// An estimate with its confidence interval.
struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// (mean(a) - mean(b)) / pooled standard deviation.
[[nodiscard]] Estimable<double> cohens_d(std::span<const double> a, std::span<const double> b);
/// Cohen's d with the exact small-sample correction by gamma functions [hedges1981].
[[nodiscard]] Estimable<double> hedges_g(std::span<const double> a, std::span<const double> b);

struct BootstrapOptions {
  std::size_t resamples = 2'000;
  double confidence = 0.95;
};

// Percentile intervals (R: quantile type 7 of the resampled estimates). Resample r draws from random.split(r).
// Resamples without spread are left out; not estimable if they are more than one in a hundred.

/// Hedges' g with a percentile bootstrap interval; a and b are resampled each by itself.
[[nodiscard]] Estimable<Interval> bootstrap_hedges_g(std::span<const double> a, std::span<const double> b,
                                                     const BootstrapOptions& options, RandomStream random);
/// Partial eta squared of every term with its percentile bootstrap interval; observations are resampled within cells.
/// Resampling adds noise that makes every share of variance larger, so the resampled shares are first moved, all alike,
/// until their mean is the estimate, and cut to [0, 1]. Costs one pass over the data per resample.
[[nodiscard]] std::vector<Estimable<Interval>> bootstrap_partial_eta_squared(
    std::span<const double> response, std::span<const Factor> factors, std::span<const std::vector<std::size_t>> terms,
    SumsOfSquares type, const BootstrapOptions& options, RandomStream random);
/// The mean with a percentile bootstrap interval. Not estimable without values.
[[nodiscard]] Estimable<Interval> bootstrap_mean(std::span<const double> values, const BootstrapOptions& options,
                                                 RandomStream random);
/// The mean with the interval of Student's t. Not estimable below two values.
[[nodiscard]] Estimable<Interval> mean_interval(std::span<const double> values, double confidence = 0.95);
/// A proportion with Wilson's score interval. @throws std::invalid_argument unless successes <= trials, trials > 0.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

}  // namespace kith
