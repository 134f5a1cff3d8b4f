#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "kith/stats/multiple.hpp"

// The studentised range Q = R / S: R is the range of k standard normals, and df S^2 an independent chi-squared.
//
//   P(R > r) = k Int phi(z) [Phi(z)^(k-1) - (Phi(z) - Phi(z - r))^(k-1)] dz      (z: the largest of the k)
//   P(Q > q) = Int density(s) P(R > q s) ds,   density(s) ~ s^(df-1) exp(-df s^2 / 2)
//
// Both integrands are positive, so that small tails keep their digits. Both are analytic and fade at both ends (the
// outer one as a function of u = log s), for which the trapezoidal rule converges faster than any power of its step.

namespace kith {
namespace {

double normal_lower(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// Steps were chosen so that halving them changes nothing in 13 digits.
double range_upper(double r, double groups) {
  constexpr double kReach = 8.75;  // Beyond it the integrand is below 1e-16 of its largest value.
  const double step = std::min(0.25, 0.8 / std::sqrt(groups));
  const double low = r / 2.0 - kReach;
  const double high = std::max(r / 2.0 + kReach, kReach + 1.0);
  double sum = 0.0;
  for (double z = low; z <= high; z += step) {
    const double below = normal_lower(z);
    const double density = std::exp(-0.5 * z * z) * std::pow(below, groups - 1.0);
    // 1 - (1 - share)^(k-1)
    const double share = normal_lower(z - r) / below;
    const double outside = share < 1.0 ? -std::expm1((groups - 1.0) * std::log1p(-share)) : 1.0;
    sum += density * outside;
  }
  return std::min(1.0, groups * sum * step / std::sqrt(2.0 * std::numbers::pi));
}

// Sum of f(start + i * step) over all integers i, from 0 outwards until terms no longer count. f has one peak, near
// `start`.
template <typename Function>
double sum_outwards(double start, double step, Function f) {
  constexpr double kNegligible = 1e-18;
  double sum = f(start);
  for (const double direction : {-step, step}) {
    for (double i = 1.0;; ++i) {
      const double term = f(start + i * direction);
      sum += term;
      if (term <= kNegligible * sum) break;
    }
  }
  return sum;
}

void require_range(std::size_t groups, double df, const char* message) {
  if (groups < 2 || !(df >= 2.0)) throw std::invalid_argument{message};
}

}  // namespace

double studentized_range_upper(double q, std::size_t groups, double df) {
  require_range(groups, df, "studentized_range_upper: groups and df must be >= 2");
  if (!(q >= 0.0)) throw std::invalid_argument{"studentized_range_upper: q must be >= 0"};
  if (q == 0.0) return 1.0;
  if (std::isinf(q)) return 0.0;
  const auto k = static_cast<double>(groups);
  if (std::isinf(df)) return range_upper(q, k);

  // The one bound is for how fast P(R > r) falls where groups are many, the other for the density of large df.
  const double step = std::min(0.05, 0.7 / std::sqrt(2.0 * df));
  // Of log s, with exponent 0 at its mode u = 0.
  const auto density = [df](double u) { return std::exp(df * (u - 0.5 * std::expm1(2.0 * u))); };
  // Both factors are log-concave in u, so their product has one peak: here if P(R > r) fades as exp(-r^2 / 4).
  const double mode = -0.5 * std::log1p(0.5 * q * (q / df));
  if (std::isinf(mode)) return 0.0;
  const double tail = sum_outwards(mode, step, [&](double u) {
    const double weight = density(u);
    return weight > 0.0 ? weight * range_upper(q * std::exp(u), k) : 0.0;
  });
  const double total = sum_outwards(0.0, step, density);
  return std::min(1.0, tail / total);
}

double studentized_range_quantile(double p, std::size_t groups, double df) {
  require_range(groups, df, "studentized_range_quantile: groups and df must be >= 2");
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument{"studentized_range_quantile: p must be in (0, 1)"};
  // A root of the tails' log ratio by false position, halving the weight of an end that stays (Illinois).
  const auto excess = [&](double q) { return std::log(studentized_range_upper(q, groups, df) / p); };
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
    if (std::abs(at_middle) < 1e-14) return middle;
  }
  return 0.5 * (low + high);
}

}  // namespace kith
