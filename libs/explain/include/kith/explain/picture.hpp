#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// Rows of text, top first, all of one length.
using Picture = std::vector<std::string>;

/// The map in the state in which a demonstration starts.
[[nodiscard]] Picture start_picture(const GridMap& map, StartId id);
/// A path drawn on the domain's map, one picture per leg: a leg ends with an action that does not move the robot (a
/// pick-up). Every cell shows the last move of the leg that leaves it (^ v < >), and 'o' is where the leg ends, unless
/// the path goes round for ever from a cell that the leg has left.
[[nodiscard]] std::vector<Picture> path_pictures(const Domain& domain, const GridMap& map, StartId id,
                                                 const Trajectory& path);
/// A path in words, a line per action: "go -> on the ice".
[[nodiscard]] std::string path_text(const Domain& domain, StartId id, const Trajectory& path, std::size_t indent);
/// The bare map, the start picture and the legs of the path beside each other, each row indented; without a map the
/// path in words.
[[nodiscard]] std::string start_and_path(const Domain& domain, StartId id, const Trajectory& path, std::size_t indent);
/// What the robot does wherever it stands, while items and stations are as in `configuration`.
/// @param choice  per state of the MDP, as in DrawnPolicy::choice.
[[nodiscard]] Picture policy_picture(const Domain& domain, const GridMap& map, MdpIndex m,
                                     std::span<const std::uint32_t> choice, const GridState& configuration);
/// The state with the robot at another cell; what it carries comes along.
[[nodiscard]] GridState with_robot_at(GridState state, const Cell& cell);
/// The states of a path before its end, without those in which only the robot is elsewhere than in one before.
[[nodiscard]] std::vector<GridState> configurations_on(const Domain& domain, const GridMap& map, MdpIndex m,
                                                       const Trajectory& path);
/// "parcel at (4,3), 1 station left": what a state is like apart from where the robot is.
[[nodiscard]] std::string configuration_in_words(const GridMap& map, MdpIndex m, const GridState& state);
/// Pictures beside each other, each row indented.
[[nodiscard]] std::string beside(const std::vector<Picture>& pictures, std::size_t indent);

/// The robot's policy as pictures show it.
struct DrawnPolicy {
  std::vector<std::uint32_t> choice;  ///< Per state, an index into Mdp::choices().
  Trajectory path;  ///< From the initial state; by likeliest outcomes, until it ends or repeats itself.
};

/// Nothing if no policy has a finite return.
[[nodiscard]] std::optional<DrawnPolicy> policy_to_draw(const Domain& domain, MdpIndex m);

}  // namespace kith
