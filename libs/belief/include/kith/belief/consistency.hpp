#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith {

/// Which members of a team agree: the largest sets of members whose half-spaces
/// have a common region.
struct ConsistentSubsets {
  std::vector<std::vector<std::size_t>> subsets;  ///< Each sorted; the list is sorted lexicographically; never empty.
  std::vector<std::vector<HalfSpace>> reduced_lists;  ///< Per member, what remains of its own list, in its order.
};

/// All largest sets of members whose half-spaces, together with `prior`, leave a
/// common region with interior. Members with an empty list are never excluded and
/// appear in every set. A member whose own list has no region with the prior is
/// first reduced to its largest consistent sub-list (ties: the one that keeps
/// newer, i.e. later, half-spaces); nothing may remain of it, and then it counts
/// as an empty list. No members give one empty set.
///
/// Exact. In three dimensions in time cubic in the number of different half-spaces: every cell of the
/// arrangement of all boundary planes, cut further by the coordinate planes, is a
/// sector about one of the rays in which two planes meet. The rays are walked
/// through, and each sector knows, by integer signs, whom it satisfies. In other dimensions by trying without the
/// members of irreducible conflicts (irreducible_conflict), the fewest first.
/// @throws std::overflow_error if a product of normals leaves 64 bits, which cannot happen while entries stay below
/// 2^30.
[[nodiscard]] ConsistentSubsets largest_consistent_subsets(std::span<const std::vector<HalfSpace>> lists,
                                                           const Cone& prior);

}  // namespace kith
