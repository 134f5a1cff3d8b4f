#include "kith/teaching/cache.hpp"

#include <algorithm>

namespace kith {

void TeachingCache::trim() {
  constexpr std::size_t kMuch = 50'000;
  const Atlas& atlas = known_->behaviours.atlas();
  if (atlas.is_tabulated() || constraints().size() + regions().size() + behaviours().num_cells() < kMuch) return;
  known_ = std::make_unique<Known>(atlas);
}

const PriorCover& TeachingCache::cover(const Cone& prior, std::size_t num_points) {
  const auto known = std::find_if(covers_.begin(), covers_.end(), [&](const PriorCover& cover) {
    return cover.size() == num_points && cover.prior() == prior;
  });
  return known != covers_.end() ? *known : covers_.emplace_back(prior, num_points);
}

}  // namespace kith
