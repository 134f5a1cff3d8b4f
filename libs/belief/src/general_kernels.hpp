#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/core/stream.hpp"
#include "kith/geometry/half_space.hpp"

// What kernels.hpp does in three dimensions, in d = 2 to 8: the same meaning, by plain loops in double precision.
// Points are one array of shape [d, n], axis by axis.
namespace kith::detail {

// Points of the sphere of d dimensions.
struct AxisPoints {
  std::span<const double> values;  // shape [d, n]
  std::size_t dimension = 0;
  [[nodiscard]] std::size_t size() const noexcept { return values.size() / dimension; }
  [[nodiscard]] std::span<const double> axis(std::size_t k) const { return values.subspan(k * size(), size()); }
};

// out[i] = log of the product of relative likelihoods at point i. The half-spaces are summed in sorted order, so that
// the order of the list cannot change the rounding.
void log_relative_products(const AxisPoints& points, std::span<const HalfSpace> half_spaces,
                           const HalfSpaceLikelihood& likelihood, std::span<double> out);

// Point i of `out` = point index[i] of `points`, which is another array.
void gather(const AxisPoints& points, std::span<const std::uint32_t> index, std::span<double> out);

// sum_i weights[i] points[i].
[[nodiscard]] Direction weighted_sum(const AxisPoints& points, std::span<const double> weights);

// sum_i weights[i] angle(points[i], centre)^2.
[[nodiscard]] double weighted_square_angles(const AxisPoints& points, std::span<const double> weights,
                                            const Direction& centre);

// Sum of the weights of the points inside all of the half-spaces.
[[nodiscard]] double weight_inside(const AxisPoints& points, std::span<const double> weights,
                                   std::span<const HalfSpace> half_spaces);

// Moves every point by N(0, angle^2) per axis in its tangent space, through the exponential map. A move to where some
// normal . p < 0 is drawn again up to 20 times, else the point stays.
void move_points(std::span<double> values, std::size_t dimension, double angle, std::span<const Direction> normals,
                 RandomStream& random);

}  // namespace kith::detail
