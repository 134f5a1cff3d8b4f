#pragma once

#include <string_view>

#include "kith/stats/estimable.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

/// The differences that are too small to matter: low < difference < high, in the units of the response (of the link of
/// a model). For a smallest effect of interest s they are -s and s.
struct EquivalenceBounds {
  double low = 0.0;
  double high = 0.0;
};

/// What a test of difference and a test of equivalence, each at level alpha, say together.
enum class EquivalenceVerdict {
  kDifferent,               ///< Differs from 0, and may be large enough to matter.
  kEquivalent,              ///< Too small to matter; not shown to differ from 0.
  kDifferentAndEquivalent,  ///< Differs from 0, but by too little to matter.
  kUndecided,               ///< Neither is shown: more observations are needed.
};
[[nodiscard]] std::string_view to_string(EquivalenceVerdict verdict) noexcept;

/// Two one-sided t tests of equivalence [schuirmann1987].
struct Equivalence {
  double estimate = 0.0;
  EquivalenceBounds bounds;
  TestResult above_low;       ///< One-sided, against a difference of bounds.low or less.
  TestResult below_high;      ///< One-sided, against a difference of bounds.high or more.
  double p = 1.0;             ///< The larger of both: equivalent if it is below alpha.
  Interval narrow;            ///< At confidence 1 - 2 alpha: inside the bounds if p is below alpha.
  Interval wide;              ///< At confidence 1 - alpha: without 0 if the difference is significant.
  double p_difference = 1.0;  ///< Two-sided, against 0.
  EquivalenceVerdict verdict = EquivalenceVerdict::kUndecided;
};

// Each throws std::invalid_argument unless bounds.low < bounds.high, both finite, and alpha is in (0, 0.5).

/// @param standard_error  > 0. @param df  > 0, possibly infinite. @throws std::invalid_argument also if they are not.
[[nodiscard]] Equivalence test_equivalence(double estimate, double standard_error, double df, EquivalenceBounds bounds,
                                           double alpha = 0.05);
/// Of Welch's or a paired t test.
[[nodiscard]] Equivalence test_equivalence(const MeanDifference& difference, EquivalenceBounds bounds,
                                           double alpha = 0.05);
/// Of a contrast of a model. The test against 0 is the contrast's own, adjusted if that is; tests of equivalence are
/// not adjusted for other contrasts. Not estimable as the contrast's inference is not.
[[nodiscard]] Estimable<Equivalence> test_equivalence(const LinearEstimate& contrast, EquivalenceBounds bounds,
                                                      double alpha = 0.05);

}  // namespace kith
