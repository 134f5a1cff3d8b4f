#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith::rivals {

/// Steps before a belief begins anew, about those of a session.
inline constexpr std::uint64_t kSession = 32;

/// n half-spaces as demonstrations of one robot convey them, and what contradicts them.
struct Evidence {
  explicit Evidence(std::size_t n);

  /// In turns the one and the other, so that a belief that sees them never settles.
  [[nodiscard]] const std::vector<HalfSpace>& at(std::uint64_t turn) const {
    return turn % 2 == 0 ? half_spaces : opposite;
  }

  std::vector<HalfSpace> half_spaces;
  std::vector<HalfSpace> opposite;
};

/// Steps cost something: what learners know of item delivery.
[[nodiscard]] std::vector<HalfSpace> prior_half_spaces();
[[nodiscard]] Cone prior_cone();

}  // namespace kith::rivals
