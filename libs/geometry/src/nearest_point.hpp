#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "kith/core/math.hpp"

namespace kith::detail {

// At most eight by eight, in place.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 8, 8>;

[[nodiscard]] inline SmallMatrix chosen_columns(const Eigen::MatrixXd& all, const std::array<std::uint32_t, 8>& which,
                                                std::size_t count) {
  SmallMatrix result(all.rows(), static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    result.col(static_cast<Eigen::Index>(k)) = all.col(static_cast<Eigen::Index>(which[k]));
  }
  return result;
}

// x^(n/2)
[[nodiscard]] inline double half_power(double x, std::size_t n) {
  double result = n % 2 == 0 ? 1.0 : std::sqrt(x);
  for (std::size_t k = 0; k < n / 2; ++k) result *= x;
  return result;
}

// 1 / m^2, where m is the distance of the origin from the convex hull of vectors with this Gram matrix, by the
// algorithm of Wolfe. Never too small, except by rounding: what is returned follows from a hyperplane that
// separates the hull from the origin, wherever the iteration stopped. Infinite if there is none.
[[nodiscard]] double inverse_square_distance(const SmallMatrix& gram);

// Uniform numbers to a uniform point lambda of the standard simplex with one coordinate more, one after the other:
// what is left is split off by the minimum of as many uniforms.
class SimplexMap {
 public:
  explicit SimplexMap(std::span<const double> uniforms) : uniforms_{uniforms} {}

  [[nodiscard]] double next() {
    if (uniforms_.empty()) return left_;
    const double rest = left_ * root(1.0 - uniforms_.front(), uniforms_.size());
    uniforms_ = uniforms_.subspan(1);
    const double result = left_ - rest;
    left_ = rest;
    return result;
  }

 private:
  static double root(double x, std::size_t degree) {
    if (degree == 1) return x;
    if (degree == 2) return std::sqrt(x);
    if (degree == 4) return std::sqrt(std::sqrt(x));
    return math::pow(x, 1.0 / static_cast<double>(degree));
  }

  std::span<const double> uniforms_;
  double left_ = 1.0;
};

}  // namespace kith::detail
