#pragma once

#include <optional>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/files/reader.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith {

/// The half-spaces of a learner type's `prior`, a list of tables { feature = integer }.
/// Nothing if the domain is unknown (null), or after reporting what is wrong: an unknown feature, a normal of zeros, a
/// half-space that does not hold at the robot's weights, or no region in common.
/// @param is_of_older  the region of an older robot: it need not hold, and normals may be long.
[[nodiscard]] std::optional<std::vector<HalfSpace>> read_prior(const TomlArray& list, const TomlPlace& place,
                                                               const Domain* domain, TomlReport& report,
                                                               bool is_of_older = false);
/// `knowing` of a learner type as it is kept: { robot = "...", halfspaces = [...] }.
[[nodiscard]] TomlTable knowing_table(const OlderRobot& robot, const Domain& domain);

}  // namespace kith
