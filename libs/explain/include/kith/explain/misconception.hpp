#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// A constraint that somebody violates, and how far.
struct Misbelief {
  HalfSpace violated;  ///< Holds for the robot.
  /// A weaker constraint that the person satisfies: the normal of `violated` with entry `unit` replaced. Nothing if no
  /// limit is known.
  std::optional<std::int64_t> limit{};
  std::size_t unit = 0;  ///< The feature in which amounts are told, such as steps.
  friend bool operator==(const Misbelief&, const Misbelief&) = default;

  /// What the person satisfies, if a limit is known. @pre the normal that it leads to is not zero.
  [[nodiscard]] std::optional<HalfSpace> satisfied() const;
};

/// `violated` with `n` more of the unit on the side that makes it weaker for everybody who agrees with the robot on
/// whether the unit is a cost or a gain; nothing if no feature would be left.
[[nodiscard]] std::optional<Misbelief> weakened(const Domain& domain, const HalfSpace& violated, std::size_t unit,
                                                std::int64_t n);

/// What the person thinks: "crossing rubble costs more than a step, but at most 2 steps", "crossing rubble costs at
/// most 2 steps", "stopping at the charger is worth at least what 4 steps cost". Where the words do not allow it,
/// in_words() of the opposite: "2 steps cost more than crossing rubble".
[[nodiscard]] std::string in_words(const Domain& domain, const Misbelief& misbelief);

}  // namespace kith
