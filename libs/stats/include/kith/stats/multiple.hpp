#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

/// How p-values of a family of tests are adjusted: so that the chance of any false claim stays below alpha (Bonferroni,
/// Holm), or the expected share of false claims among all claims (false discovery rate) [benjamini1995].
enum class Correction { kNone, kBonferroni, kHolm, kFdr };
[[nodiscard]] std::string_view to_string(Correction correction) noexcept;

/// Adjusted p-values, in the order given, in [0, 1] (R: p.adjust).
[[nodiscard]] std::vector<double> adjust(std::span<const double> p_values, Correction correction);

/// P(Q > q) of the studentised range of `groups` means with `df` degrees of freedom, which may be infinite. The
/// integral that defines it, within 1e-10 relative for up to 1000 groups, however small. R's
/// ptukey(lower.tail = FALSE) agrees within 1e-6 where it is accurate itself; for few degrees of freedom or large q it
/// is off by up to two percent, and 0 for large q. Costs a fraction of a millisecond.
/// @throws std::invalid_argument unless q >= 0, groups >= 2, df >= 2 (R's limits).
[[nodiscard]] double studentized_range_upper(double q, std::size_t groups, double df);
/// The q with studentized_range_upper(q, groups, df) = p, for p in (0, 1).
[[nodiscard]] double studentized_range_quantile(double p, std::size_t groups, double df);

/// One pair of groups of a Tukey test.
struct PairwiseDifference {
  std::size_t first = 0;  ///< Indices of levels; the difference is mean(second) - mean(first), as in R.
  std::size_t second = 0;
  double difference = 0.0;
  double low = 0.0;  ///< Simultaneous confidence interval.
  double high = 0.0;
  double p = 1.0;  ///< Adjusted for all pairs.
};
/// Tukey's honestly significant differences with the Tukey-Kramer standard error, in R's order of pairs.
/// @param means, counts  per group. @param mean_square, df  of the residuals of the model.
[[nodiscard]] Estimable<std::vector<PairwiseDifference>> tukey_hsd(std::span<const double> means,
                                                                   std::span<const std::size_t> counts,
                                                                   double mean_square, double df,
                                                                   double confidence = 0.95);

/// One pair of groups of a Games-Howell test.
struct UnequalVariancePair {
  std::size_t first = 0;  ///< Indices of levels; the difference is mean(second) - mean(first).
  std::size_t second = 0;
  /// Welch's standard error and degrees of freedom; interval and p by the studentised range of all groups.
  Estimable<MeanDifference> difference = Estimable<MeanDifference>::impossible("not computed");
};
/// Pairwise differences without equal variances [games1976], of the groups that have observations; in the order of
/// tukey_hsd(). A pair says why it cannot be compared: fewer than two values in a group, no spread in both, or fewer
/// than two degrees of freedom. Not estimable with fewer than two groups.
/// @throws std::invalid_argument as welch_anova() does, or if confidence is not in (0, 1).
[[nodiscard]] Estimable<std::vector<UnequalVariancePair>> games_howell(std::span<const double> values,
                                                                       const Factor& groups, double confidence = 0.95);

}  // namespace kith
