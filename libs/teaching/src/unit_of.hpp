#pragma once

#include <span>

#include "imagined_people.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {

// The unit of these demonstrations, with what they convey to the imagined people; those that convey nothing are left
// out.
[[nodiscard]] Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const StartIndex> demonstrations,
                           const ImaginedPeople& people);

// The same, with what they convey to these people each.
struct ShownTo {
  StartIndex start;
  ConstraintSet conveyed;                  // minimal
  const ImaginedPeople* people = nullptr;  // never null
};
[[nodiscard]] Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const ShownTo> demonstrations);

}  // namespace kith
