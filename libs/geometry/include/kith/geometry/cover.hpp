#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith {

/// n points of a Fibonacci lattice on the unit sphere; shape [3, n], columns are points.
/// Point i has z = 1 - (2 i + 1) / n and azimuth 2 pi i / golden ratio.
[[nodiscard]] Eigen::Matrix3Xd fibonacci_cover(std::size_t n);

/// Exactly n points of a regular cover of the cone's part of the sphere: the
/// smallest Fibonacci cover with at least n points inside, thinned evenly to n.
/// Shape [3, n]. @throws std::invalid_argument if n == 0.
[[nodiscard]] Eigen::Matrix3Xd fibonacci_cover(const Cone& region, std::size_t n);

/// Deserno's regular placement of about n points in rings of equal area
/// (actual counts differ slightly: 500 -> 500, 1000 -> 998, 2500 -> 2500). Shape [3, count].
[[nodiscard]] Eigen::Matrix3Xd deserno_cover(std::size_t n);

/// Greedy k-centres (Gonzalez 1985): indices of k points, the first given, each
/// next one the farthest (geodesic) from those chosen; ties: the lower index.
/// @param points shape [3, n]; @pre k <= n, first < n.
[[nodiscard]] std::vector<std::size_t> k_centres(const Eigen::Matrix3Xd& points, std::size_t k, std::size_t first);

/// The geodesic median of weighted points: minimises sum_i weight_i * angle(c, p_i)
/// by Weiszfeld-like fixed-point iteration on the sphere, at most 100 steps.
/// @param points shape [3, n]; @param weights shape [n], >= 0.
[[nodiscard]] Eigen::Vector3d geodesic_median(const Eigen::Matrix3Xd& points, std::span<const double> weights);

}  // namespace kith
