#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/core/stream.hpp"
#include "kith/geometry/half_space.hpp"

// Points of the sphere in d = 2 to 8 dimensions: three have kernels of their own (kernels.hpp), the others share those
// of general_kernels.hpp. This is the one place that chooses between them.
namespace kith::detail {

// What is asked of points, shape [d, n], axis by axis, that others own.
class SpherePoints {
 public:
  SpherePoints(std::span<const double> values, std::size_t dimension) : values_{values}, dimension_{dimension} {}

  // out[i] = log of the product of relative likelihoods at point i, whatever the order of the half-spaces.
  void log_relative_products(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                             std::span<double> out) const;
  // Sum of the weights of the points inside all of the half-spaces.
  [[nodiscard]] double weight_inside(std::span<const double> weights, std::span<const HalfSpace> half_spaces) const;
  // The direction of the weighted sum; that of the first point if the sum vanishes.
  [[nodiscard]] Direction mean_direction(std::span<const double> weights) const;
  // sum_i weights[i] angle(point i, centre)^2.
  [[nodiscard]] double square_angles(std::span<const double> weights, const Direction& centre) const;
  // The same, good to 1e-5, for weights of at most 1.
  [[nodiscard]] double rough_square_angles(std::span<const double> weights, const Direction& centre) const;

 private:
  std::span<const double> values_;
  std::size_t dimension_;
};

// Moves every point by N(0, angle^2) per axis in its tangent space, inside the half-spaces of the normals.
void move_points(std::vector<double>& values, std::size_t dimension, double angle,
                 const std::vector<Direction>& normals, RandomStream& random);

// Point i becomes what point index[i] was, moved like that if the angle is not 0.
void draw_points(std::vector<double>& values, std::size_t dimension, std::span<const std::uint32_t> index, double angle,
                 const std::vector<Direction>& normals, RandomStream& random);

}  // namespace kith::detail
