#pragma once

#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith::detail {

// The minimal set of what the constraint leaves of the prior; empty if it contradicts it.
[[nodiscard]] inline std::vector<HalfSpace> target_facets(const Cone& prior, const HalfSpace& constraint) {
  const auto region = prior.clipped(constraint);
  return region ? region->minimal_set() : std::vector<HalfSpace>{};
}

}  // namespace kith::detail
