#pragma once

#include <cstdint>
#include <optional>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// The half-space of weights that prefer one behaviour to another, from the
/// difference of their feature counts in units of 1 / scale.
///
/// Integer counts (scale 1) give it exactly. Otherwise, and where the entries are too large for exact cones in d
/// dimensions, the normal is rounded to integers of length at most 2^20 for d = 2 and 3, 2^19 for d = 4, else
/// 2^floor(62 / (d - 1)): an error of its direction below sqrt(d) / 2 over that length.
/// Nothing if the difference is none: zero, or with a scale no entry above 1e-4 counts.
[[nodiscard]] std::optional<HalfSpace> preference(const IntegerVector& difference, std::int64_t scale);

/// The same for what tells the robot's behaviour from another one, `loss` = robot's counts - the other's. Nothing
/// also if, in domains that are not exact, the rounded half-space does not hold strictly at the robot's weights: there
/// the two are as good as equal.
[[nodiscard]] std::optional<HalfSpace> preference_of_robot(const Domain& domain, const IntegerVector& loss);

}  // namespace kith
