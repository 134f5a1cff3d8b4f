#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/stats/effect_size.hpp"
#include "kith/stats/tests.hpp"

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
  std::optional<double> median;  ///< First time with S <= 1/2, as R's survfit has it (mean with the next step where
                                 ///< S is exactly 1/2); missing if never reached.
};
/// @param times   > 0 and finite. @param observed  false: censored, the event lies beyond the time.
/// @throws std::invalid_argument if shapes differ or a time is not positive and finite.
[[nodiscard]] SurvivalCurve kaplan_meier(std::span<const double> times, const std::vector<bool>& observed,
                                         double confidence = 0.95);

/// Log-rank test of equal survival of k groups, chi-squared with k - 1 degrees of freedom (R: survdiff, rho = 0).
[[nodiscard]] Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed,
                                             const Factor& groups);
/// The same within strata, summed over them (R: survdiff with strata()).
[[nodiscard]] Estimable<TestResult> log_rank(std::span<const double> times, const std::vector<bool>& observed,
                                             const Factor& groups, const Factor& strata);

}  // namespace kith
