#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/grid_map.hpp"

namespace kith {

/// How a terrain is drawn, in pictures and on pages.
struct Surface {
  std::string name;  ///< Of the terrain.
  /// "brown", "blue", "green", "purple", "grey", "orange", "red", "yellow" or, of holes, "dark".
  std::string_view tint;
  std::string_view pattern;  ///< "dots", "lines", "cross" or "waves".
};

/// One for every terrain of the map, in the order of its legend. Terrains whose name says so have a tint of their own
/// (grass is green, ice is blue); no two of up to 32 have tint and pattern in common.
[[nodiscard]] std::vector<Surface> surfaces_of(const GridMap& map);

}  // namespace kith
