#pragma once

#include <optional>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/toml/reader.hpp"

namespace kith {

/// The half-spaces of a learner type's `prior`, a list of tables { feature = integer }.
/// Nothing if the domain is unknown (null), or after reporting what is wrong: an unknown feature, a normal of zeros, a
/// half-space that does not hold at the robot's weights, or no region in common.
[[nodiscard]] std::optional<std::vector<HalfSpace>> read_prior(const TomlArray& list, const TomlPlace& place,
                                                               const Domain* domain, TomlReport& report);

}  // namespace kith
