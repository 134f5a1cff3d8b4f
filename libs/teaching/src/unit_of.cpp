#include "unit_of.hpp"

#include <vector>

namespace kith {

Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const ShownTo> demonstrations) {
  Unit unit;
  auto region = cache.numbers_of(view.taught_region);
  for (const auto& shown : demonstrations) {
    const auto effect = cache.regions().effect(region, shown.conveyed);
    unit.demonstrations.push_back({.start = shown.start,
                                   .half_spaces = cache.constraints().half_spaces(shown.conveyed),
                                   .gain = effect.gain,
                                   .num_new = effect.num_new,
                                   .counterfactuals = shown.people->weights});
    region = cache.regions().minimal(region | shown.conveyed);
  }
  unit.taught_region = cache.constraints().half_spaces(region);
  return unit;
}

Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const StartIndex> demonstrations,
             const ImaginedPeople& people) {
  std::vector<ShownTo> all;
  for (const auto start : demonstrations) {
    auto conveyed = cache.regions().minimal(cache.behaviours().conveyed(start, people.cells));
    if (!conveyed.empty()) all.push_back({start, std::move(conveyed), &people});
  }
  return unit_of(cache, view, all);
}

}  // namespace kith
