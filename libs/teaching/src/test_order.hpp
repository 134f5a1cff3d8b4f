#pragma once

#include <span>
#include <vector>

#include "kith/teaching/test_selection.hpp"

namespace kith {

// Of starts that test the same the one that is asked: with TestPreferences::avoids_shortest one that people get wrong
// who only take the shortest path, if there is any; then the most complex picture, then the one least like the unit's
// demonstrations on average, then chance. @pre there is one. @param preferences  null: shortest paths do not matter.
[[nodiscard]] StartIndex test_to_ask(const Atlas& atlas, std::span<const StartIndex> starts,
                                     const std::vector<Demonstration>& unit, const RandomStream& random,
                                     const TestPreferences* preferences);

}  // namespace kith
