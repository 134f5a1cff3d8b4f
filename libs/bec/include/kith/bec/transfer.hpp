#pragma once

#include <optional>

#include "kith/bec/atlas.hpp"

namespace kith {

/// Where the keys of a demonstration lead from another start.
struct Transfer {
  IntegerVector counts;            ///< Feature counts so far.
  std::optional<StartIndex> rest;  ///< Where a way of one's own goes on; nothing at the end of the path.
};

/// Presses the keys of the demonstration one after the other, passing over those that do nothing, until the path ends
/// or there are no more [lage2019]. Where behaviours are not tabulated only the first key is pressed, and the robot's
/// way taken from there; nothing if it does nothing.
[[nodiscard]] std::optional<Transfer> transferred(const Atlas& atlas, StartIndex demonstration, StartIndex test);

}  // namespace kith
