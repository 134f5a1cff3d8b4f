#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// A robot as it was before an update, as far as people who know it well know it.
struct OlderRobot {
  std::string name;               ///< Id of its domain.
  std::vector<HalfSpace> region;  ///< Its behaviour equivalence class within its prior: minimal, sorted.
  friend bool operator==(const OlderRobot&, const OlderRobot&) = default;
};

/// The robot of an atlas, as people know it.
[[nodiscard]] OlderRobot older_robot(const Atlas& atlas);

/// What is left of a prior for people who know a region within it, such as OlderRobot::region; nothing if no interior
/// is left. @throws std::invalid_argument unless both have the same dimension.
[[nodiscard]] std::optional<Cone> known_within(Cone prior, std::span<const HalfSpace> region);

/// Why people who know one robot know nothing about another, as a message; empty if they have the same features.
[[nodiscard]] std::string why_incomparable(const Domain& older, const Domain& newer);

/// What an update changed, as constraints of the new robot's knowledge components that its prior does not imply;
/// sorted.
struct RobotUpdate {
  std::vector<HalfSpace> now;    ///< What people who know the older robot do not know; none: nothing changed.
  std::vector<HalfSpace> still;  ///< What holds as before.
};

/// @param known  the older robot's region within the new one's prior.
[[nodiscard]] RobotUpdate update_of(const Atlas& atlas, const Cone& known);

}  // namespace kith
