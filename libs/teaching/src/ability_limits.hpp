#pragma once

namespace kith::detail {

// Of people who are presumed, not observed: what gains lead to at most, and what a likelihood takes at most.
inline constexpr double kHighestAbility = 0.95;
inline constexpr double kCertain = 1.0 - 1e-9;

}  // namespace kith::detail
