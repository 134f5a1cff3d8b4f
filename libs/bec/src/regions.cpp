#include "kith/bec/regions.hpp"

#include <algorithm>
#include <bit>

#include "kith/core/assert.hpp"

namespace kith {
namespace {

constexpr std::size_t kCloudPoints = 4096;
// Lessons of a component start from the same region again and again.
constexpr std::size_t kComparisons = 8;

std::size_t num_common(std::span<const Cloud::Mask* const> masks, const Cloud::Mask& everything,
                       std::optional<std::size_t> without = std::nullopt) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < everything.size(); ++k) {
    std::uint64_t word = everything[k];
    for (std::size_t i = 0; i < masks.size(); ++i) {
      if (i != without) word &= (*masks[i])[k];
    }
    count += static_cast<std::size_t>(std::popcount(word));
  }
  return count;
}

}  // namespace

// Two sets of constraints and a node of a hash table per region; the points that were compared last beside them.
std::size_t Regions::memory() const noexcept {
  const std::size_t words = (table_->size() / 64 + 1) * sizeof(std::uint64_t);
  const std::size_t per_region = sizeof(ConstraintSet) + sizeof(Region) + 2 * words + 8 * sizeof(void*);
  std::size_t bytes = (known_.size() + minimal_.size()) * per_region;
  for (const auto& comparison : comparisons_) {
    bytes += kCloudPoints * (table_->dimension() * sizeof(double) + comparison.masks.size() / 8);
  }
  return bytes;
}

std::optional<Cone> Regions::cone_of(const ConstraintSet& set) const {
  const auto half_spaces = table_->half_spaces(set);
  if (half_spaces.empty()) return Cone{table_->dimension()};
  return Cone::intersection(half_spaces);
}

const Region& Regions::of(const ConstraintSet& set) {
  const auto known = known_.find(set);
  if (known != known_.end()) return known->second;
  Region region;
  if (const auto cone = cone_of(set)) {
    region.minimal = table_->set_of(cone->minimal_set());
    const SolidAngle area = cone->measure();
    region.area_sr = area.value;
    region.area_error = area.standard_error;
  } else {
    region.minimal = set;
  }
  return known_.emplace(set, std::move(region)).first->second;
}

const ConstraintSet& Regions::minimal(const ConstraintSet& set) {
  if (table_->dimension() <= 3) return of(set).minimal;
  const auto known = minimal_.find(set);
  if (known != minimal_.end()) return known->second;
  const auto cone = cone_of(set);
  return minimal_.emplace(set, cone ? table_->set_of(cone->minimal_set()) : set).first->second;
}

RegionEffect Regions::effect(const ConstraintSet& taught, const ConstraintSet& added) {
  if (table_->dimension() > 3) return compare(taught, added);
  const ConstraintSet both = taught | added;
  if (both == taught) return {};
  const Region& after = of(both);
  KITH_ASSERT(after.area_sr > 0.0);  // the robot's weights satisfy everything that is conveyed
  if (taught_ == nullptr || !(taught_->first == taught)) {
    static_cast<void>(of(taught));
    taught_ = &*known_.find(taught);
  }
  return {taught_->second.area_sr / after.area_sr, after.minimal.without(taught).count()};
}

Regions::Comparison& Regions::comparison_with(const ConstraintSet& taught) {
  const auto known = std::find_if(comparisons_.begin(), comparisons_.end(),
                                  [&](const Comparison& one) { return one.taught == taught; });
  if (known != comparisons_.end()) {
    comparisons_.splice(comparisons_.begin(), comparisons_, known);
    return comparisons_.front();
  }
  const auto cone = cone_of(taught);
  KITH_ASSERT(cone.has_value());
  if (comparisons_.size() == kComparisons) comparisons_.pop_back();
  return comparisons_.emplace_front(taught, Cloud{ConeSampler{*cone}, kCloudPoints});
}

RegionEffect Regions::compare(const ConstraintSet& taught, const ConstraintSet& added) {
  auto& [region, cloud, known_masks] = comparison_with(taught);
  const std::size_t n = cloud.size();
  const Cloud::Mask everything = cloud.mask(std::span<const HalfSpace>{});
  // In an order that does not depend on the numbering; those that cut nothing off are left out.
  std::vector<ConstraintIndex> order = added.without(taught).members();
  std::sort(order.begin(), order.end(),
            [&](ConstraintIndex a, ConstraintIndex b) { return (*table_)[a] < (*table_)[b]; });
  std::vector<const Cloud::Mask*> masks;
  for (const ConstraintIndex c : order) {
    auto place = known_masks.find(c);
    if (place == known_masks.end()) {
      place = known_masks.emplace(c, cloud.mask((*table_)[c])).first;
    }
    if (place->second != everything) masks.push_back(&place->second);
  }

  const std::size_t left = num_common(masks, everything);
  if (left == n) return {};
  for (std::size_t i = 0; i < masks.size();) {
    if (num_common(masks, everything, i) == left) {
      masks.erase(masks.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  const double share = left > 0 ? static_cast<double>(left) : 0.5;
  return {static_cast<double>(n) / share, masks.size()};
}

}  // namespace kith
