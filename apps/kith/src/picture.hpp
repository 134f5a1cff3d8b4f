#pragma once

#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith::cli {

/// Rows of text, top first, all of one length.
using Picture = std::vector<std::string>;

/// The map in the state in which a demonstration starts.
[[nodiscard]] Picture start_picture(const Domain& domain, DemoId id);
/// A path drawn on the map: at every cell the last move that leaves it (^ v < >), other actions by their first letter,
/// and 'o' where the robot ends. What nobody walks over is as in the start picture.
[[nodiscard]] Picture path_picture(const Domain& domain, DemoId id, const Trajectory& path);
/// What the robot does wherever it stands, while items and stations are as in `configuration`.
[[nodiscard]] Picture policy_picture(const Atlas& atlas, MdpIndex m, const GridState& configuration);
/// Pictures beside each other, each row indented.
[[nodiscard]] std::string beside(const std::vector<Picture>& pictures, std::size_t indent);

}  // namespace kith::cli
