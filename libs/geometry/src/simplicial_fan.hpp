#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/geometry/half_space.hpp"

namespace kith::detail {

// Cuts the pointed cone of these facets and extreme rays, in `rank` dimensions, into simplicial cones by pulling:
// a face is the union of the cones from one of its rays over the sub-facets that do not contain the ray. `rank`
// indices of rays for each. The ray on most sub-facets is pulled (ties: the first), which makes few of them.
// @throws std::length_error for more than a million.
[[nodiscard]] std::vector<std::uint32_t> triangulate(std::span<const HalfSpace> facets,
                                                     std::span<const IntegerVector> rays, std::size_t rank);

}  // namespace kith::detail
