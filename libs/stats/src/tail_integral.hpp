#pragma once

#include <cmath>
#include <limits>

namespace kith::detail {

// Sum of f(start + i * step) over all integers i, from 0 outwards until terms no longer count. f has one peak, near
// `start`. As a trapezoidal rule it converges faster than any power of its step if f is analytic.
template <typename Function>
double sum_outwards(double start, double step, Function f) {
  constexpr double kNegligible = 1e-18;
  double sum = f(start);
  for (const double direction : {-step, step}) {
    for (int i = 1;; ++i) {
      const double term = f(start + i * direction);
      sum += term;
      if (term <= kNegligible * sum) break;
    }
  }
  return sum;
}

// The density, up to a factor, of u = log s where df s^2 is chi-squared with df degrees of freedom; 1 at its mode u =
// 0.
inline double log_scale_density(double u, double df) { return std::exp(df * (u - 0.5 * std::expm1(2.0 * u))); }

// The q with tail(q) = p, for a tail that falls from 1 at 0: a root of their log ratio by false position, halving the
// weight of an end that stays (Illinois).
template <typename Tail>
double upper_quantile(double p, Tail tail) {
  const auto excess = [&](double q) { return std::log(tail(q) / p); };
  double low = 0.0;
  double at_low = -std::log(p);
  double high = 4.0;
  double at_high = excess(high);
  while (at_high > 0.0) {
    low = high;
    at_low = at_high;
    high *= 2.0;
    at_high = excess(high);
  }
  for (int i = 0; i < 200 && high - low > 4.0 * std::numeric_limits<double>::epsilon() * high; ++i) {
    const bool bounded = std::isfinite(at_high);
    const double middle = bounded ? (low * at_high - high * at_low) / (at_high - at_low) : 0.5 * (low + high);
    const double at_middle = excess(middle);
    if (at_middle == 0.0) return middle;
    if (at_middle > 0.0) {
      low = middle;
      at_low = at_middle;
      at_high *= 0.5;
    } else {
      high = middle;
      at_high = at_middle;
      at_low *= 0.5;
    }
    if (std::abs(at_middle) < 1e-13) return middle;
  }
  return 0.5 * (low + high);
}

}  // namespace kith::detail
