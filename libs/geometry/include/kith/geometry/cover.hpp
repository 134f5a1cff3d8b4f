#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// Exactly n points of a regular cover of the cone's part of the sphere, however
/// thin it is: the Fibonacci lattice of the unit square, u = 1/2 + i / golden
/// ratio modulo 1 and v = (i + 1/2) / n, under Cone::equal_area_point. Shape
/// [3, n].
/// @throws std::invalid_argument if n == 0, or unless the cone has three dimensions.
[[nodiscard]] Eigen::Matrix3Xd fibonacci_cover(const Cone& region, std::size_t n);

/// Exactly n points that cover the cone's part of the sphere evenly, in any
/// dimension: ConeSampler::cover. Shape [d, n]. @throws std::invalid_argument if n == 0.
[[nodiscard]] Eigen::MatrixXd cover(const Cone& region, std::size_t n);
/// The same with the axes in an order that follows from what they mean, axes[0] first: then the points do not depend on
/// the order in which they stand here. Shape [d, n]. @pre axes holds 0 to d - 1, each once.
[[nodiscard]] Eigen::MatrixXd cover(const Cone& region, std::size_t n, std::span<const std::size_t> axes);

/// Greedy k-centres (Gonzalez 1985): indices of k points, the first given, each
/// next one the farthest (geodesic) from those chosen; ties: the lower index.
/// @param points shape [d, n], columns of length 1.
/// @throws std::invalid_argument unless k <= n and first < n.
[[nodiscard]] std::vector<std::size_t> k_centres(const Eigen::MatrixXd& points, std::size_t k, std::size_t first);

}  // namespace kith
