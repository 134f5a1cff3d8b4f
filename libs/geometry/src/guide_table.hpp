#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kith::detail {

// Draws from a cumulative distribution with a few comparisons each, by the method of guide tables (Chen and Asau,
// 1974). Finds what std::upper_bound finds. The distribution must outlive it.
class GuideTable {
 public:
  // `cumulative`: ascending, at least one; its last element is the sum.
  explicit GuideTable(std::span<const double> cumulative)
      : cumulative_{cumulative}, begins_(std::bit_ceil(2 * cumulative.size())) {
    const auto size = static_cast<double>(begins_.size());
    std::size_t at = 0;
    for (std::size_t b = 0; b < begins_.size(); ++b) {
      at = advance(at, static_cast<double>(b) / size * cumulative_.back());
      begins_[b] = static_cast<std::uint32_t>(at);
    }
  }

  // The first position whose sum exceeds `share`, in [0, 1), of the whole; the last one if none does.
  [[nodiscard]] std::size_t find(double share) const {
    // Exact, since the size is a power of two; and products with the sum keep the order.
    const auto bucket = static_cast<std::size_t>(share * static_cast<double>(begins_.size()));
    return advance(begins_[std::min(bucket, begins_.size() - 1)], share * cumulative_.back());
  }

 private:
  [[nodiscard]] std::size_t advance(std::size_t at, double target) const {
    while (at + 1 < cumulative_.size() && cumulative_[at] <= target) ++at;
    return at;
  }

  std::span<const double> cumulative_;
  std::vector<std::uint32_t> begins_;
};

}  // namespace kith::detail
