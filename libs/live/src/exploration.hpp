#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/geometry/half_space.hpp"
#include "kith/live/live_study.hpp"
#include "kith/live/room_event.hpp"
#include "views.hpp"

namespace kith {

/// What the robot does there.
struct Exploration {
  view::Explored shown;
  std::vector<HalfSpace> conveyed;  ///< What the path tells about the weights; all hold strictly at the robot's.
};

/// Whether people can explore the worlds of a domain: there is a map or a picture, small enough to be changed by hand.
[[nodiscard]] bool can_explore(const Domain& domain);

/// Whether the map can be changed, too: a domain file with the rows of one.
[[nodiscard]] bool can_change_map(const LiveStudy& study);

/// Symbols of things that can be put anywhere on the map: floor, walls, terrain, stations.
[[nodiscard]] std::vector<std::string> placeable_symbols(const Domain& domain);

/// Never throws for what people send.
[[nodiscard]] Exploration explored(const LiveStudy& study, const happening::Explored& asked);
[[nodiscard]] Exploration explored(const Atlas& atlas, StartIndex start);

}  // namespace kith
