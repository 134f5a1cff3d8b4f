#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kith::detail {

// ends[i] = how many of the points (k + u) / n, k = 0 ... n-1, lie below the
// cumulative weight of 0 ... i, relative to the sum of all; the last index of
// positive weight ends at n whatever rounding says.
// @throws std::invalid_argument unless the weights are >= 0 with a positive, finite sum and n < 2^32.
[[nodiscard]] std::vector<std::uint32_t> systematic_ends(std::span<const double> weights, std::size_t n, double u);

// The index of each of the n draws, in order.
[[nodiscard]] std::vector<std::uint32_t> systematic_indices(std::span<const double> weights, std::size_t n, double u);

}  // namespace kith::detail
