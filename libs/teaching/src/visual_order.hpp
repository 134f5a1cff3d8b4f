#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/core/stream.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/visited_starts.hpp"

namespace kith {

// How a candidate looks beside others; the smallest key is taken.
struct VisualKey {
  std::int64_t complexity = 0;
  std::int64_t dissimilarity = 0;
  std::uint64_t chance = 0;  // a seeded permutation of all demonstrations
  friend auto operator<=>(const VisualKey&, const VisualKey&) = default;
};

// The last resort among equals, the same for a demonstration whoever else is there.
[[nodiscard]] inline std::uint64_t chance_of(StartIndex start, const RandomStream& random) {
  return random.split(start.value()).address();
}

// Whether some member of the class was not met yet.
[[nodiscard]] bool has_unvisited(const Atlas& atlas, StartClassIndex c, const VisitedStarts& visited);

// The demonstration to show next in a unit, of those of the classes that were not met yet: the simplest picture most
// similar to the last one, then chance. @pre some member of some class was not met yet.
[[nodiscard]] StartIndex simplest_of(const Atlas& atlas, std::span<const StartClassIndex> classes,
                                     const VisitedStarts& visited, const std::vector<Demonstration>& unit,
                                     const RandomStream& random);

}  // namespace kith
