#include "imagined_people.hpp"

#include <algorithm>

#include "kith/bec/near_miss.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

// The first particle at which the cumulative weight exceeds q.
std::size_t quantile(const ParticleBelief& belief, double q) {
  const auto weights = belief.weights();
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    if (sum > q) return i;
  }
  return weights.size() - 1;
}

}  // namespace

void ImaginedPeople::add(Behaviours& behaviours, const Direction& person) {
  const auto cell = behaviours.locate(person);
  const auto place = std::lower_bound(cells.begin(), cells.end(), cell);
  if (place != cells.end() && *place == cell) return;
  cells.insert(place, cell);
  weights.push_back(person);
}

ImaginedPeople imagine_people(TeachingCache& cache, std::span<const ParticleBelief* const> beliefs,
                              const NumImagined& num, double prior_offset, RandomStream random) {
  std::vector<Direction> drawn;
  const auto& cover = cache.cover(cache.atlas().prior_cone(), beliefs.front()->size());
  const auto positions = [](std::size_t n, double offset) {
    std::vector<double> result;
    for (std::size_t i = 0; i < n; ++i) result.push_back((static_cast<double>(i) + offset) / static_cast<double>(n));
    return result;
  };
  const auto at = [](double position, std::size_t size) {
    return std::min(static_cast<std::size_t>(position * static_cast<double>(size)), size - 1);
  };
  for (const double position : positions(num.prior, prior_offset)) {
    drawn.push_back(cover.point(at(position, cover.size())));
  }
  for (const double position : positions(num.beliefs, uniform01(random))) {
    const auto i = at(position, beliefs.size());
    const double within = position * static_cast<double>(beliefs.size()) - static_cast<double>(i);
    drawn.push_back(beliefs[i]->point(quantile(*beliefs[i], within)));
  }
  ImaginedPeople people;
  for (const auto& weights : drawn) people.add(cache.behaviours(), weights);
  return people;
}

void imagine_near_misses(TeachingCache& cache, const ConstraintSet& region, const ConstraintSet& facets, double miss,
                         ImaginedPeople& people) {
  Cone cone{cache.atlas().domain().num_features()};  // the region may have no half-space at all
  const bool has_room = cone.clip(cache.constraints().half_spaces(region));
  KITH_ASSERT(has_room);  // the robot's weights lie inside
  for (const auto& weights : near_misses(cone, cache.constraints().half_spaces(facets), miss)) {
    people.add(cache.behaviours(), weights);
  }
}

}  // namespace kith
