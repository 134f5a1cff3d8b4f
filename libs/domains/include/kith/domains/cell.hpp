#pragma once

#include <compare>

namespace kith {

/// A cell of a map, 1-based, x to the right, y up.
struct Cell {
  int x = 0;
  int y = 0;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

}  // namespace kith
