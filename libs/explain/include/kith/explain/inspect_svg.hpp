#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// A picture as a file.
struct SvgFile {
  std::string name;  ///< "map.svg"
  std::string text;
};

/// Pictures of what can be shown of any domain: its map and the robot's policy in one MDP.
[[nodiscard]] std::vector<SvgFile> domain_pictures(const Domain& domain, MdpIndex m);
/// Pictures of what can be taught: the region of weights behind the policy, how many paths people could expect from
/// every start, and these paths from the map's start.
[[nodiscard]] std::vector<SvgFile> atlas_pictures(const Atlas& atlas, MdpIndex m);

/// Writes the pictures to a folder, which is made if need be: all or none. @throws kith::Error, see FileSet.
void write_pictures(const std::filesystem::path& folder, const std::vector<SvgFile>& files);

}  // namespace kith
