#include "kith/teaching/cache.hpp"

#include <algorithm>

namespace kith {

std::span<const std::uint64_t> TeachingCache::conveyed_by_class(const Atlas& atlas,
                                                                std::span<const PolicyCellIndex> cells) {
  conveyed_by_cell_.resize(atlas.cells().size());
  conveyed_.assign(atlas.num_demo_classes() * atlas.words_per_set(), 0);
  for (const auto cell : cells) {
    auto& rows = conveyed_by_cell_[cell.value()];
    if (rows.empty()) rows = atlas.conveyed_by_class({&cell, 1});
    const std::uint64_t* const from = rows.data();  // unchecked, for speed
    std::uint64_t* const to = conveyed_.data();
    for (std::size_t i = 0; i < rows.size(); ++i) to[i] |= from[i];
  }
  return conveyed_;
}

const PriorCover& TeachingCache::cover(const Cone& prior, std::size_t num_points) {
  const auto known = std::find_if(covers_.begin(), covers_.end(), [&](const PriorCover& cover) {
    return cover.size() == num_points && cover.prior() == prior;
  });
  return known != covers_.end() ? *known : covers_.emplace_back(prior, num_points);
}

}  // namespace kith
