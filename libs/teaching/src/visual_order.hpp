#pragma once

#include <cstdint>

#include "kith/bec/atlas.hpp"
#include "kith/random/stream.hpp"

namespace kith {

// How a candidate looks beside others; the smallest key is taken.
struct VisualKey {
  std::int64_t complexity = 0;
  std::int64_t dissimilarity = 0;
  std::uint64_t chance = 0;  // a seeded permutation of all demonstrations
  friend auto operator<=>(const VisualKey&, const VisualKey&) = default;
};

// The last resort among equals, the same for a demonstration whoever else is there.
[[nodiscard]] inline std::uint64_t chance_of(DemoIndex demo, const RandomStream& random) {
  return random.split(demo.value()).address();
}

}  // namespace kith
