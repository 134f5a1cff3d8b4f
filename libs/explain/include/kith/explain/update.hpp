#pragma once

#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// What people hear who know the robot as it was before an update.
struct UpdateInWords {
  /// Sentences without a full stop; of parts of the robot in which something is new only that.
  std::vector<std::string> now, still;
  std::vector<std::string> news;  ///< The same of all of RobotUpdate::now.
  std::string text;  ///< "The robot has been updated. Now crossing rubble is better than 2 steps. As before, ..."
};
/// @param known  the older robot's region within the prior.
[[nodiscard]] UpdateInWords update_in_words(const Atlas& atlas, const Cone& known);

}  // namespace kith
