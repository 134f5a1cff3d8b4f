#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// n points of a Fibonacci lattice on the unit sphere; shape [3, n], columns are points.
/// Point i has z = 1 - (2 i + 1) / n and azimuth 2 pi i / golden ratio.
[[nodiscard]] Eigen::Matrix3Xd fibonacci_cover(std::size_t n);

/// Exactly n points of a regular cover of the cone's part of the sphere, however
/// thin it is: the Fibonacci lattice of the unit square, u = 1/2 + i / golden
/// ratio modulo 1 and v = (i + 1/2) / n, under Cone::equal_area_point. Shape
/// [3, n]. For the whole sphere this is fibonacci_cover(n) turned by half a turn.
/// @throws std::invalid_argument if n == 0, or unless the cone has three dimensions.
[[nodiscard]] Eigen::Matrix3Xd fibonacci_cover(const Cone& region, std::size_t n);

/// Exactly n points that cover the cone's part of the sphere evenly, in any
/// dimension: ConeSampler::cover. Shape [d, n]. @throws std::invalid_argument if n == 0.
[[nodiscard]] Eigen::MatrixXd cover(const Cone& region, std::size_t n);

/// Deserno's regular placement [deserno2004] of about n points in rings of equal
/// width (actual counts differ slightly: 500 -> 500, 1000 -> 998, 2500 -> 2500).
/// Shape [3, count]. @throws std::invalid_argument if n == 0.
[[nodiscard]] Eigen::Matrix3Xd deserno_cover(std::size_t n);

/// Greedy k-centres (Gonzalez 1985): indices of k points, the first given, each
/// next one the farthest (geodesic) from those chosen; ties: the lower index.
/// @param points shape [3, n], columns of length 1.
/// @throws std::invalid_argument unless k <= n and first < n.
[[nodiscard]] std::vector<std::size_t> k_centres(const Eigen::Matrix3Xd& points, std::size_t k, std::size_t first);
/// The same in d dimensions. @param points shape [d, n], columns of length 1.
[[nodiscard]] std::vector<std::size_t> k_centres(const Eigen::MatrixXd& points, std::size_t k, std::size_t first);

/// The geodesic median of weighted points: minimises sum_i weight_i * angle(c, p_i)
/// by Weiszfeld's fixed-point iteration on the sphere,
///   c <- normalised sum_i weight_i p_i / sin(angle(c, p_i)),
/// from the mean direction, until it moves by less than 1e-12 or for 100 steps.
/// A minimum is certain only for points within a quarter turn of it. Points
/// whose mean is zero have no such start; then the heaviest point is returned.
/// @param points shape [3, n], columns of length 1; @param weights shape [n], >= 0.
/// @throws std::invalid_argument unless there is one weight for each point, each
/// is at least 0, and their sum is positive and finite.
[[nodiscard]] Eigen::Vector3d geodesic_median(const Eigen::Matrix3Xd& points, std::span<const double> weights);
/// The same in d = 2 to 8 dimensions. @param points shape [d, n], columns of length 1.
[[nodiscard]] Direction geodesic_median(const Eigen::MatrixXd& points, std::span<const double> weights);

}  // namespace kith
