#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith::detail {

// The logarithm of a density on the sphere that is uniform within a prior and falls beyond half-spaces:
//   log p(x) = sum over the half-spaces with u . x < 0 of far + slope (u . x),   far <= 0, slope >= 0.
struct FallingDensity {
  std::size_t dimension = 0;
  std::vector<double> prior;    // unit normals, row-major, shape [., d]: u . x >= 0
  std::vector<double> normals;  // unit normals, row-major, shape [n, d]
  std::vector<double> far;      // shape [n]
  std::vector<double> slope;    // shape [n]
};

// Moves every point `sweeps` times in such a way that the density stays what it was: along random great circles, by
// slice sampling with shrinkage [habeck2023; neal2003]. Points outside the prior stay. `values` has shape [d, n], axis
// by axis.
void move_in_density(const FallingDensity& density, std::size_t sweeps, std::span<double> values, RandomStream& random);

}  // namespace kith::detail
