#pragma once

#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith {

/// All largest sets of members whose half-spaces, together with `prior`, leave a
/// common region with interior. Members with an empty list are never excluded and
/// appear in every set. A member whose own list has no region with the prior is
/// first reduced to its largest consistent sub-list (ties: the one that keeps
/// newer, i.e. later, half-spaces).
///
/// Exact, in time polynomial in the number of half-spaces: the cells of the
/// arrangement of all boundary planes are enumerated, and each knows whom it satisfies.
struct ConsistentSubsets {
  std::vector<std::vector<std::size_t>> subsets;       ///< Each sorted; the list is sorted lexicographically; never empty.
  std::vector<std::vector<HalfSpace>> reduced_lists;   ///< Per member, what remains of its own list.
};
[[nodiscard]] ConsistentSubsets largest_consistent_subsets(std::span<const std::vector<HalfSpace>> lists,
                                                           const Cone& prior);

}  // namespace kith
