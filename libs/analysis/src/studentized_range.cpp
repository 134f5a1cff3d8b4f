#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "kith/analysis/multiple.hpp"
#include "root.hpp"

// The studentised range Q = R / S: R is the range of k standard normals, and df S^2 an independent chi-squared.
//
//   P(R > r) = k Int phi(z) [Phi(z)^(k-1) - (Phi(z) - Phi(z - r))^(k-1)] dz      (z: the largest of the k)
//   P(Q > q) = Int density(s) P(R > q s) ds,   density(s) ~ s^(df-1) exp(-df s^2 / 2)
//
// Both integrands are positive, so that small tails keep their digits. Both are analytic and fade at both ends (the
// outer one as a function of u = log s), for which the trapezoidal rule converges faster than any power of its step.
//
// The steps below leave a relative error of 1e-11 at most for up to 1000 groups, found by dividing them by three.

namespace kith {
namespace {

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
double log_scale_density(double u, double df) { return std::exp(df * (u - 0.5 * std::expm1(2.0 * u))); }

double normal_lower(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// P(R > r) for many r: what depends on z alone is computed once.
class RangeTail {
 public:
  explicit RangeTail(double groups) : groups_{groups}, step_{std::min(0.35, 1.0 / std::sqrt(groups))} {}

  double operator()(double r) {
    const auto first = static_cast<std::size_t>(std::max(0.0, r / 2.0 / step_));
    const auto last = static_cast<std::size_t>((std::max(r / 2.0, 1.0) + 2.0 * kReach) / step_);
    extend_to(last);
    double sum = 0.0;
    for (auto i = first; i <= last; ++i) {
      const auto& point = points_[i];
      if (point.weight == 0.0) continue;
      const double share = std::min(1.0, normal_lower(point.z - r) / point.below);
      // 1 - (1 - share)^(k-1), and its limit where that would be rounded
      const double outside =
          share < 1e-17 ? (groups_ - 1.0) * share : -std::expm1((groups_ - 1.0) * std::log1p(-share));
      sum += point.weight * outside;
    }
    return std::min(1.0, groups_ * sum * step_ / std::sqrt(2.0 * std::numbers::pi));
  }

 private:
  static constexpr double kReach = 8.75;  // Beyond it the integrand is below 1e-16 of its largest value.

  struct Point {
    double z = 0.0;
    double below = 0.0;   // Phi(z)
    double weight = 0.0;  // exp(-z^2 / 2) Phi(z)^(k-1)
  };

  // Points are at -kReach, -kReach + step, ...
  void extend_to(std::size_t last) {
    while (points_.size() <= last) {
      const double z = static_cast<double>(points_.size()) * step_ - kReach;
      const double below = normal_lower(z);
      points_.push_back({z, below, std::exp(-0.5 * z * z) * std::pow(below, groups_ - 1.0)});
    }
  }

  double groups_;
  double step_;
  std::vector<Point> points_;
};

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
  RangeTail range_upper{k};
  if (std::isinf(df)) return range_upper(q);

  // Bounded by how steeply P(R > r) falls, steeper for many groups, and by the width of the density.
  const double step = std::min(groups <= 20 ? 0.1 : 0.05, 0.7 / std::sqrt(2.0 * df));
  const auto density = [df](double u) { return log_scale_density(u, df); };
  // Both factors are log-concave in u, so their product has one peak: here if P(R > r) fades as exp(-r^2 / 4).
  const double mode = -0.5 * std::log1p(0.5 * q * (q / df));
  if (std::isinf(mode)) return 0.0;
  const double tail = sum_outwards(mode, step, [&](double u) {
    const double weight = density(u);
    return weight > 0.0 ? weight * range_upper(q * std::exp(u)) : 0.0;
  });
  const double total = sum_outwards(0.0, step, density);
  return std::min(1.0, tail / total);
}

double studentized_range_quantile(double p, std::size_t groups, double df) {
  require_range(groups, df, "studentized_range_quantile: groups and df must be >= 2");
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument{"studentized_range_quantile: p must be in (0, 1)"};
  const auto excess = [&](double q) {
    return std::log(std::max(studentized_range_upper(q, groups, df), std::numeric_limits<double>::min()) / p);
  };
  double high = 4.0;
  while (excess(high) > 0.0) high *= 2.0;
  return detail::root_between(0.0, high, 49, excess);
}

}  // namespace kith
