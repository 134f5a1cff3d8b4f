#pragma once

#include <optional>
#include <span>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// What can be said in small numbers about a constraint on reward weights.
struct ShortStatement {
  HalfSpace said;
  /// If there is one, `said` follows only for those who agree with it: that a feature is a cost, or a gain.
  std::optional<HalfSpace> condition;
};

/// A short statement that follows from a constraint. The constraint itself if its numbers are short: where feature
/// counts are exact, up to 1000; otherwise numbers with at most two significant digits, up to 1000. If they are not, a
/// statement with such numbers that holds for all weights that satisfy the constraint and the prior or, failing that,
/// `together` and the prior as well or, failing that, the constraint, the prior and `condition`. Of several the one
/// that says most in few digits; rounding changes at most half of what the constraint weighs to the robot, and what is
/// known beforehand does not imply it. Implication is checked exactly (Cone::implies).
/// @param together  other constraints that are conveyed at the same time.
/// @return Nothing if no short statement follows.
[[nodiscard]] std::optional<ShortStatement> short_statement(const Domain& domain, const HalfSpace& half_space,
                                                            std::span<const HalfSpace> together = {});

}  // namespace kith
