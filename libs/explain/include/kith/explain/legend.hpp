#pragma once

#include <string>

#include "kith/explain/picture.hpp"

namespace kith {

/// The map as it lies there in the state in which a demonstration starts: walls, terrain, stations still there
/// and destinations, without robot and items.
[[nodiscard]] Picture bare_picture(const GridMap& map, StartId id);

/// What the symbols of all pictures mean, one line each for the domain's own and for those that move. Empty without a
/// map.
[[nodiscard]] std::string legend(const Domain& domain, std::size_t indent);

}  // namespace kith
