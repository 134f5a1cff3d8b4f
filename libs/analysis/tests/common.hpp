#pragma once

// What the tests of several files use.

#include <cstddef>
#include <limits>
#include <vector>

namespace kith::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The terms of two factors with their interaction.
inline const std::vector<std::vector<std::size_t>> kCrossed{{0}, {1}, {0, 1}};
/// Those without it, and those of a single factor.
inline const std::vector<std::vector<std::size_t>> kAdditive{{0}, {1}}, kAlone{{0}};

}  // namespace kith::testing
