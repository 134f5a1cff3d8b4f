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

/// Symbols of things that can be put anywhere on the map: floor, walls, terrain, stations. None if it cannot be
/// changed.
[[nodiscard]] std::vector<std::string> placeable_symbols(const LiveStudy& study);

/// Between which bounds features lie by the prior and whatever else is known: brackets_json().
/// @param features  all but the one that they are weighed against, unless given.
[[nodiscard]] Json known_brackets(const Atlas& atlas, const std::vector<HalfSpace>& more,
                                  std::vector<std::size_t> features = {});

/// Never throws for what people send.
[[nodiscard]] Exploration explored(const LiveStudy& study, const happening::Explored& asked);
[[nodiscard]] Exploration explored(const Atlas& atlas, StartIndex start);

}  // namespace kith
