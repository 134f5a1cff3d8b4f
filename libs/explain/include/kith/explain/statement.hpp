#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// The smallest number that people keep in mind that is at least n (`up`), or the largest that is at most n: whole
/// numbers up to 20, then multiples of 5 up to 100, then of 10. @param n  >= 0.
[[nodiscard]] std::int64_t round_number(std::int64_t n, bool up) noexcept;

/// What can be said in small numbers about a constraint on reward weights.
struct ShortStatement {
  HalfSpace said;
  /// If there is one, `said` follows only for those who agree with it: that a feature is a cost, or a gain.
  std::optional<HalfSpace> condition;
};

/// A short statement that follows from a constraint. The constraint itself if its numbers are short: where feature
/// counts are exact, up to 1000; otherwise round numbers up to 1000 (any up to 20, then multiples of 5, above 100 of
/// 10), of which one may be large: the second largest is at most 10 or, if the statement is about three things or more,
/// 3, and the others are 1. If they are not, a statement with such numbers that holds for all weights that satisfy the
/// constraint and the prior or, failing that, `together` and the prior as well or, failing that, the constraint, the
/// prior and `condition`. Of several the one that says most in few digits; rounding changes at most half of what the
/// constraint weighs to the robot, and what is known beforehand does not imply it. Implication is checked exactly
/// (Cone::implies).
/// @param together  other constraints that are conveyed at the same time.
/// @return Nothing if no short statement follows.
[[nodiscard]] std::optional<ShortStatement> short_statement(const Domain& domain, const HalfSpace& half_space,
                                                            std::span<const HalfSpace> together = {});

/// short_statement() of each of some constraints that are conveyed together, in their order. Nothing where none follows
/// and, unless counts are exact, where another of the statements implies it for those who know the prior: of a weaker
/// statement beside a stronger one only the stronger is left, of two that say the same the first, and of
/// two that compare the same things in numbers that differ by a quarter at most the one without a condition.
/// @param together  further constraints that are conveyed at the same time.
[[nodiscard]] std::vector<std::optional<ShortStatement>> short_statements(const Domain& domain,
                                                                          std::span<const HalfSpace> half_spaces,
                                                                          std::span<const HalfSpace> together = {});

}  // namespace kith
