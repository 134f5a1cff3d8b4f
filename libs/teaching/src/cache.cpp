#include "kith/teaching/cache.hpp"

#include <algorithm>

namespace kith {

std::size_t TeachingCache::memory() const noexcept { return known_->behaviours.memory() + known_->regions.memory(); }

void TeachingCache::trim() {
  if (memory() <= max_bytes_ && !partitions_->is_full()) return;
  known_.reset();  // first, so that both are never held
  if (partitions_->is_full()) partitions_->clear();
  known_ = std::make_unique<Known>(*atlas_, max_bytes_, partitions_);
}

const PriorCover& TeachingCache::cover(const Cone& prior, std::size_t num_points) {
  const auto known = std::find_if(covers_.begin(), covers_.end(), [&](const PriorCover& cover) {
    return cover.size() == num_points && cover.prior() == prior;
  });
  return known != covers_.end() ? *known : covers_.emplace_back(prior, num_points);
}

const std::shared_ptr<const Exam>& TeachingCache::shared_exam() {
  constexpr std::size_t kPriorPoints = 1000;  // to find out how difficult starts are
  if (!exam_) exam_ = std::make_shared<const Exam>(behaviours(), cover(atlas_->prior_cone(), kPriorPoints));
  return exam_;
}

}  // namespace kith
