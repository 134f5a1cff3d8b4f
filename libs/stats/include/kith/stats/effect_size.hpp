#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kith/random/stream.hpp"
#include "kith/stats/anova.hpp"
#include "kith/stats/estimable.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

/// (mean(a) - mean(b)) / pooled standard deviation.
[[nodiscard]] Estimable<double> cohens_d(std::span<const double> a, std::span<const double> b);
/// Cohen's d with the exact small-sample correction by gamma functions [hedges1981].
[[nodiscard]] Estimable<double> hedges_g(std::span<const double> a, std::span<const double> b);

/// Cohen's d and Hedges' g of the same difference, each with its interval.
struct StandardizedDifference {
  Interval d;
  Interval g;  ///< d times the small-sample correction [hedges1981].
};
/// (mean(a) - mean(b)) / pooled standard deviation, with the interval of the non-central t distribution [steiger2004],
/// exact for normal values of equal variance.
/// Not estimable as hedges_g() is not.
[[nodiscard]] Estimable<StandardizedDifference> standardized_difference(std::span<const double> a,
                                                                        std::span<const double> b,
                                                                        double confidence = 0.95);
/// d_z: the mean of the differences of pairs over their standard deviation, with the interval of the non-central t
/// distribution. Not estimable as paired_t_test() is not, or below three pairs.
/// @throws std::invalid_argument as paired_t_test() does.
[[nodiscard]] Estimable<StandardizedDifference> paired_standardized_difference(std::span<const double> a,
                                                                               std::span<const double> b,
                                                                               double confidence = 0.95);
/// A contrast of a model over its residual standard deviation. The interval is that of the non-central t distribution
/// times standard error / residual_sd; exact in linear models, approximate in others.
/// Not estimable without standard error or residual standard deviation, below two degrees of freedom, or if the link is
/// not the identity.
[[nodiscard]] Estimable<StandardizedDifference> standardized_contrast(const FixedEffects& model,
                                                                      const LinearEstimate& contrast,
                                                                      double confidence = 0.95);

/// The share of variance that a term explains, of what it leaves unexplained and its own.
struct VarianceShare {
  Interval partial_eta_squared;
  double partial_omega_squared = 0.0;  ///< df (F - 1) / (df (F - 1) + n), less biased; 0 if F < 1.
};
/// Partial eta squared of a term that is tested by F(df, residual df) on n observations. Its interval lambda /
/// (lambda + n) is that of the non-centrality lambda of F [steiger2004], as in f_test_power(); below an F that
/// is expected by chance it begins at 0, and is all 0 for still smaller ones. Not estimable as the term's test is not.
/// @throws std::invalid_argument unless observations > 0 and confidence is in (0, 1).
[[nodiscard]] Estimable<VarianceShare> variance_share(const AnovaTerm& term, std::size_t observations,
                                                      double confidence = 0.95);

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
/// variance(a) / variance(b) with a percentile bootstrap interval, for values that are not normal.
[[nodiscard]] Estimable<Interval> bootstrap_variance_ratio(std::span<const double> a, std::span<const double> b,
                                                           const BootstrapOptions& options, RandomStream random);
/// The mean with a percentile bootstrap interval. Not estimable without values.
[[nodiscard]] Estimable<Interval> bootstrap_mean(std::span<const double> values, const BootstrapOptions& options,
                                                 RandomStream random);
/// The mean with the interval of Student's t. Not estimable below two values.
[[nodiscard]] Estimable<Interval> mean_interval(std::span<const double> values, double confidence = 0.95);
/// A proportion with Wilson's score interval. @throws std::invalid_argument unless successes <= trials, trials > 0.
[[nodiscard]] Interval wilson_interval(std::size_t successes, std::size_t trials, double confidence = 0.95);

}  // namespace kith
