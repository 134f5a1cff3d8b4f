#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"
#include "kith/analysis/tests.hpp"

namespace kith {

/// One step of a Kaplan-Meier curve.
struct SurvivalStep {
  double time = 0.0;
  std::size_t at_risk = 0;
  std::size_t events = 0;
  double survival = 1.0;  ///< S(time), after the events
  double low = 0.0;       ///< Interval on the log scale with Greenwood's variance (R: survfit's default),
  double high = 1.0;      ///< cut to [0, 1]; both equal `survival` when it is 0.
};
struct SurvivalCurve {
  std::vector<SurvivalStep> steps;  ///< At every time with an event or a censored observation, ascending.
  std::size_t observations = 0;
  std::size_t events = 0;
  /// First time with S <= 1/2, as R prints a survfit: the mean of that time and the next with a smaller S where S is
  /// 1/2 there (within 1.5e-8, as it is a product that rounds). Missing if S stays above 1/2.
  std::optional<double> median;
};
/// The share of observations whose event lies beyond each time, estimated from times of which some are censored:
/// S(t) = product over event times t_j <= t of (1 - events / at risk). Censored observations are at risk at their own
/// time. Equals R's survfit(timefix = FALSE) to 1e-10 relative.
///
/// @param times     > 0 and finite; ties are times that are exactly equal.
/// @param observed  one per time; false: censored, the event lies beyond the time.
/// @throws std::invalid_argument if shapes differ, a time is not positive and finite, or confidence is not in (0, 1).
[[nodiscard]] SurvivalCurve kaplan_meier(std::span<const double> times, const std::vector<bool>& observed,
                                         double confidence = 0.95);

/// Log-rank test of equal survival of k groups, chi-squared with k - 1 degrees of freedom (R: survdiff, rho = 0, to
/// 1e-10 relative). As in R, groups that nobody was left in when the first event happened do not count.
///
/// Not estimable without events, with fewer than two groups, or if no event compares some of the groups with the
/// others because they are never at risk together, or only when everybody at risk has the event at once.
/// @throws std::invalid_argument as kaplan_meier() does, or if a factor has not one of its levels per time.
[[nodiscard]] Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed,
                                             const Factor& groups);
/// The same within strata, summed over them (R: survdiff with strata()).
[[nodiscard]] Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed,
                                             const Factor& groups, const Factor& strata);

}  // namespace kith
