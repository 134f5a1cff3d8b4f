#pragma once

#include "kith/bec/atlas.hpp"

namespace kith {

// Whether lessons show and examine their whole component. With tables what a lesson conveys is known to the last
// comparison, so it is enough to examine that. Where people's behaviours are planned when they are met, a component has
// many facets and a lesson may leave some out: it asks for these, too, and once people have answered rightly, later
// lessons take the answers for known.
[[nodiscard]] inline bool teaches_whole_components(const Atlas& atlas) { return atlas.find_tables() == nullptr; }

}  // namespace kith
