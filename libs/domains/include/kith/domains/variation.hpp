#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/domain.hpp"

namespace kith {

/// The domain file with another map and with nothing optional: a family of one MDP. Comments, features, rules, reward
/// and words stay as they are.
/// @param text  a sound domain file.
/// @param id    the new domain's.
/// @param rows  top row first, in symbols of the file's legend.
/// @return nothing if the new file is not sound: the map has no start or two, say, or is written in a way that is
/// not understood here.
[[nodiscard]] std::optional<std::string> with_one_map(std::string_view text, const std::string& id,
                                                      const std::vector<std::string>& rows);

}  // namespace kith
