#pragma once

#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// People who only just miss a facet of a region and are right about everything else, one per facet.
///
/// With p the normalised sum of the region's extreme rays on a facet of unit normal n, and c that of all extreme rays,
/// they hold p - miss (n . c) n, normalised: as far outside the facet as the region's centre is inside, times `miss`.
/// Outside that facet for certain; inside all others if `miss` is small against the size of the facet.
///
/// @param facets  some of the region's facets. @param miss  > 0.
/// @return one per facet, shape [d] each.
[[nodiscard]] std::vector<Direction> near_misses(const Cone& region, std::span<const HalfSpace> facets, double miss);

}  // namespace kith
