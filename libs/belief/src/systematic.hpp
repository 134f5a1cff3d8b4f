#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kith::detail {

// ends[i] = how many of the points (k + u) / n, k = 0 ... n-1, lie below the
// cumulative weight of 0 ... i, relative to the sum of all; the last index of
// positive weight ends at n whatever rounding says.
// @throws std::invalid_argument unless the weights are >= 0 with a positive, finite sum, u is in [0, 1) and n < 2^31.
void systematic_ends(std::span<const double> weights, std::size_t n, double u, std::span<std::uint32_t> ends);

// The index of each of the n draws, in order, in index[0 ... n-1]. The index has room for n + kIndexRoom; what is
// written beyond n means nothing.
inline constexpr std::size_t kIndexRoom = 8;
void systematic_indices(std::span<const double> weights, double u, std::span<std::uint32_t> index);

}  // namespace kith::detail
