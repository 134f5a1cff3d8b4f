#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kith {

/// A quadratic in d variables on the cube [-1, 1]^d, fitted by ridge regression, that stands for a simulation.
///
/// The terms are products of Legendre polynomials of degree at most 2, orthonormal for the uniform distribution, so
/// that the variance over the cube is the sum of squared coefficients and splits into shares of the variables
/// [sobol2001]. All but the constant are shrunk; how much is chosen by the leave-one-out error.
class ResponseSurface {
 public:
  /// @param points  shape [n][d], in [-1, 1]; n >= 3. @param values  shape [n].
  /// @throws std::invalid_argument if the shapes differ or there are fewer points.
  ResponseSurface(std::span<const std::vector<double>> points, std::span<const double> values);

  /// @param point  shape [d].
  [[nodiscard]] double at(std::span<const double> point) const;
  /// Root mean square of the errors at the points, each predicted without itself: what the quadratic misses and what
  /// the simulation varies.
  [[nodiscard]] double error() const noexcept { return error_; }
  /// Share of the values' variance that predictions without the point itself explain; at most 1, negative if none.
  [[nodiscard]] double explained() const noexcept { return explained_; }
  /// Share of the surface's variance over the cube that belongs to variable k alone, and to k in any term; both 0 for
  /// a flat surface.
  [[nodiscard]] double main_share(std::size_t k) const;
  [[nodiscard]] double total_share(std::size_t k) const;
  /// Value at the upper end minus value at the lower end of variable k, the others at the centre.
  [[nodiscard]] double slope(std::size_t k) const;

 private:
  std::size_t dimension_;
  std::vector<double> coefficients_;
  double error_ = 0.0;
  double explained_ = 0.0;
};

}  // namespace kith
