#pragma once

#include <array>
#include <boost/math/special_functions/log1p.hpp>
#include <cmath>
#include <cstddef>

namespace kith::detail {

// log(1 + u) / u
[[nodiscard]] inline double log1p_ratio(double u) { return u > 0.0 ? std::log1p(u) / u : 1.0; }

// (log(1 + u) - u) / u^2, which is -1/2 at 0
[[nodiscard]] inline double log1p_rest(double u) {
  return u > 1e-9 ? boost::math::log1pmx(u) / (u * u) : -0.5 + u / 3.0;
}

// The sums over j < y of log(1 + alpha j) and of its derivative by alpha, j / (1 + alpha j): term by term
// up to kDirect and by Euler's and Maclaurin's formula beyond, whose remainder there is below 1e-12.
class RisingProduct {
 public:
  explicit RisingProduct(double alpha) : alpha_{alpha} {
    for (std::size_t j = 0; j < kDirect; ++j) {
      const auto x = static_cast<double>(j);
      logs_[j + 1] = logs_[j] + std::log1p(alpha * x);
      slopes_[j + 1] = slopes_[j] + x / (1.0 + alpha * x);
    }
  }
  [[nodiscard]] double log(double y) const {
    if (y <= kDirect) return logs_[static_cast<std::size_t>(y)];
    return logs_[kDirect] + log_antiderivative(y) - log_antiderivative(kDirect);
  }
  [[nodiscard]] double slope(double y) const {
    if (y <= kDirect) return slopes_[static_cast<std::size_t>(y)];
    return slopes_[kDirect] + slope_antiderivative(y) - slope_antiderivative(kDirect);
  }

 private:
  static constexpr std::size_t kDirect = 128;

  // Integral - f / 2 + f' / 12 - f''' / 720 of f(x) = log(1 + alpha x).
  [[nodiscard]] double log_antiderivative(double x) const {
    const double u = alpha_ * x;
    const double d = alpha_ / (1.0 + u);
    return x * ((1.0 + u) * log1p_ratio(u) - 1.0) - std::log1p(u) / 2.0 + d / 12.0 - d * d * d / 360.0;
  }
  // The same of x / (1 + alpha x).
  [[nodiscard]] double slope_antiderivative(double x) const {
    const double u = alpha_ * x;
    const double d = 1.0 / (1.0 + u);
    return -x * x * log1p_rest(u) - x * d / 2.0 + d * d / 12.0 - alpha_ * alpha_ * d * d * d * d / 120.0;
  }

  double alpha_;
  std::array<double, kDirect + 1> logs_{};
  std::array<double, kDirect + 1> slopes_{};
};

}  // namespace kith::detail
