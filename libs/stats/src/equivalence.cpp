#include "kith/stats/equivalence.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kith/stats/distributions.hpp"

namespace kith {
namespace {

// P(T > t)
double student_t_upper(double t, double df) {
  const double half = student_t_two_sided(t, df) / 2.0;
  return t >= 0.0 ? half : 1.0 - half;
}

EquivalenceVerdict verdict_of(bool differs, bool is_equivalent) {
  if (differs) return is_equivalent ? EquivalenceVerdict::kDifferentAndEquivalent : EquivalenceVerdict::kDifferent;
  return is_equivalent ? EquivalenceVerdict::kEquivalent : EquivalenceVerdict::kUndecided;
}

}  // namespace

std::string_view to_string(EquivalenceVerdict verdict) noexcept {
  switch (verdict) {
    case EquivalenceVerdict::kDifferent:
      return "different";
    case EquivalenceVerdict::kEquivalent:
      return "equivalent";
    case EquivalenceVerdict::kDifferentAndEquivalent:
      return "different, but equivalent";
    case EquivalenceVerdict::kUndecided:
      break;
  }
  return "undecided";
}

Equivalence test_equivalence(double estimate, double standard_error, double df, EquivalenceBounds bounds,
                             double alpha) {
  if (!(bounds.low < bounds.high) || !std::isfinite(bounds.low) || !std::isfinite(bounds.high))
    throw std::invalid_argument{"test_equivalence: the lower bound must be below the upper one, both finite"};
  if (!(alpha > 0.0 && alpha < 0.5)) throw std::invalid_argument{"test_equivalence: alpha must be in (0, 0.5)"};
  if (!std::isfinite(estimate) || !(standard_error > 0.0) || !std::isfinite(standard_error) || !(df > 0.0))
    throw std::invalid_argument{"test_equivalence: the estimate must be finite, standard_error and df > 0"};
  Equivalence result;
  result.estimate = estimate;
  result.bounds = bounds;
  const double above = (estimate - bounds.low) / standard_error;
  const double below = (estimate - bounds.high) / standard_error;
  result.above_low = {"t", above, {df}, student_t_upper(above, df)};
  result.below_high = {"t", below, {df}, student_t_upper(-below, df)};
  result.p = std::max(result.above_low.p, result.below_high.p);
  const auto interval = [&](double tail) {
    const double reach = student_t_quantile(1.0 - tail, df) * standard_error;
    return Interval{estimate, estimate - reach, estimate + reach};
  };
  result.narrow = interval(alpha);
  result.wide = interval(alpha / 2.0);
  result.p_difference = student_t_two_sided(estimate / standard_error, df);
  result.verdict = verdict_of(result.p_difference < alpha, result.p < alpha);
  return result;
}

Equivalence test_equivalence(const MeanDifference& difference, EquivalenceBounds bounds, double alpha) {
  return test_equivalence(difference.difference, difference.standard_error, difference.test.df.at(0), bounds, alpha);
}

Estimable<Equivalence> test_equivalence(const LinearEstimate& contrast, EquivalenceBounds bounds, double alpha) {
  if (!contrast.inference) return Estimable<Equivalence>::impossible(contrast.inference.reason());
  auto result =
      test_equivalence(*contrast.estimate, contrast.inference->standard_error, contrast.inference->df, bounds, alpha);
  result.p_difference = contrast.inference->p;
  result.verdict = verdict_of(result.p_difference < alpha, result.p < alpha);
  return result;
}

}  // namespace kith
