#pragma once

#include <Eigen/Core>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith {

// The border of the cone's part of the unit sphere as a spherical polygon: corners of length 1, less than half a turn
// apart, counter-clockwise seen from outside, joined by great circles. Empty for the whole sphere, which has none. A
// hemisphere has 48 corners.
[[nodiscard]] std::vector<Eigen::Vector3d> outline(const Cone& cone);

}  // namespace kith
