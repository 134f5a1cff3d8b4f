#include "plan_unit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "kith/geometry/cone.hpp"
#include "kith/teaching/imitation_table.hpp"
#include "visual_order.hpp"

namespace kith {
namespace {

constexpr double kTie = 1e-12;  // values of U within this are equal

// Demonstration classes that convey the same.
struct Candidate {
  ConstraintSet conveyed;
  std::vector<StartClassIndex> classes;
};

// Those of the component that convey anything.
std::vector<Candidate> candidates_of(TeachingCache& cache, const KnowledgeComponent& component,
                                     std::span<const PolicyCellIndex> cells) {
  const auto conveyed = cache.behaviours().conveyed_by_class(component, cells);
  std::vector<Candidate> candidates;
  std::unordered_map<ConstraintSet, std::size_t> by_row, by_minimal;  // most classes share theirs with others
  for (const auto c : component.start_classes) {
    auto row = conveyed.set(c);
    if (row.empty()) continue;
    const auto [same, is_new] = by_row.try_emplace(std::move(row), 0);
    if (is_new) {
      const auto& minimal = cache.regions().minimal(same->first);
      const auto place = by_minimal.try_emplace(minimal, candidates.size());
      if (place.second) candidates.push_back({minimal, {}});
      same->second = place.first->second;
    }
    candidates[same->second].classes.push_back(c);
  }
  return candidates;
}

// What lessons teach that begin with the same demonstrations. Above three dimensions the region that these leave is
// found once. Of the next demonstration only the constraints matter that the region does not imply; many share those.
class TaughtAfter {
 public:
  TaughtAfter(TeachingCache& cache, std::span<const ConstraintSet> shown)
      : cache_{cache}, prior_{cache.atlas().prior()}, known_{prior_} {
    for (const auto& conveyed : shown) known_ |= conveyed;
    const auto& constraints = cache.constraints();
    if (constraints.dimension() <= 3) return;
    region_.emplace(constraints.dimension());
    if (!region_->clip(constraints.half_spaces(known_))) region_.reset();
    is_implied_.resize(constraints.size());
  }

  // T: the minimal set of all that was shown, without the prior's own.
  [[nodiscard]] ConstraintSet with(const ConstraintSet& conveyed) {
    if (!region_) return cache_.regions().minimal(known_ | conveyed).without(prior_);
    ConstraintSet added;
    for (const auto c : conveyed.members()) {
      if (!is_implied(c)) added.insert(c);
    }
    const auto [place, is_new] = minimal_.try_emplace(std::move(added));
    if (is_new) {
      auto left = *region_;
      if (left.clip(cache_.constraints().half_spaces(place->first))) {
        place->second = cache_.constraints().set_of(left.minimal_set()).without(prior_);
      }
    }
    return place->second ? *place->second : (known_ | conveyed).without(prior_);
  }

 private:
  bool is_implied(ConstraintIndex c) {
    auto& known = is_implied_[c.value()];
    if (!known) known = region_->implies(cache_.constraints()[c]);
    return *known;
  }

  TeachingCache& cache_;
  const ConstraintSet& prior_;
  ConstraintSet known_;
  std::optional<Cone> region_;                   // nothing: left to the cache
  std::vector<std::optional<bool>> is_implied_;  // per constraint: whether the region implies it
  std::unordered_map<ConstraintSet, std::optional<ConstraintSet>> minimal_;  // nothing: no interior is left
};

// The constraints of a set in the order in which people meet them.
std::vector<ConstraintIndex> in_order(const ConstraintTable& constraints, const ConstraintSet& set) {
  auto members = set.members();
  std::sort(members.begin(), members.end(),
            [&](ConstraintIndex a, ConstraintIndex b) { return constraints[a].normal() < constraints[b].normal(); });
  return members;
}

// What demonstrations are worth to people who imitate them: the grade that is expected on the starts of an
// ImitationTable, times the share of answers that are imitations.
class WorthOfImitation {
 public:
  // @param history  of what was shown before.
  WorthOfImitation(ImitationTable& table, const UnitValue& value, const PastPeriods& history)
      : table_{table},
        imitation_{value.imitation()},
        by_regret_{value.objective() == TeachingObjective::kRegret},
        worth_(table.num_starts(), 0.0),
        weight_(table.num_starts(), 0.0) {
    for (const auto& period : history) {
      for (const auto& shown : period.lesson.demonstrations) add(shown.demo);
    }
  }

  void add(StartIndex demonstration) {
    const auto row = table_.of(demonstration);
    for (std::size_t s = 0; s < row.size(); ++s) {
      const double similarity = std::exp(-row[s].distance / imitation_.temperature);
      weight_[s] += similarity;
      worth_[s] += similarity * worth_of(row[s].grade);
    }
  }

  // If this were shown, too.
  [[nodiscard]] double with(StartIndex demonstration) const {
    const auto row = table_.of(demonstration);
    double sum = 0.0;
    for (std::size_t s = 0; s < row.size(); ++s) {
      const double similarity = std::exp(-row[s].distance / imitation_.temperature);
      const double weight = weight_[s] + similarity;
      if (weight > 0.0) sum += (worth_[s] + similarity * worth_of(row[s].grade)) / weight;
    }
    return imitation_.probability * sum / static_cast<double>(std::max<std::size_t>(row.size(), 1));
  }

  // The best of some demonstrations of these classes, which are spread over them.
  struct Best {
    double worth = 0.0;
    StartIndex demo;
  };
  [[nodiscard]] Best best_of(const Atlas& atlas, std::span<const StartClassIndex> classes,
                             const VisitedStarts& visited) const {
    constexpr std::size_t kCompared = 24;
    std::vector<StartIndex> fresh, all;
    for (const auto c : classes) {
      for (const auto demo : atlas.members(c)) {
        all.push_back(demo);
        if (!visited.contains(demo)) fresh.push_back(demo);
      }
    }
    const auto& from = fresh.empty() ? all : fresh;
    const auto n = std::min(kCompared, from.size());
    std::optional<Best> best;
    for (std::size_t i = 0; i < n; ++i) {
      const auto demo = from[i * from.size() / n];
      const double worth = with(demo);
      if (!best || worth > best->worth) best = Best{worth, demo};
    }
    return best.value();
  }

 private:
  [[nodiscard]] double worth_of(const Grade& grade) const { return by_regret_ ? -grade.regret : grade.share_right; }

  ImitationTable& table_;
  Imitation imitation_;
  bool by_regret_;
  std::vector<double> worth_, weight_;  // summed over what was shown, shape [starts]
};

// U of demonstrations that convey and teach this, for people who take in the first `capacity` constraints of a lesson.
double value_of_shown(TeachingCache& cache, UnitValue& value, std::span<const ConstraintSet> shown,
                      const ConstraintSet& taught, std::size_t capacity) {
  if (capacity == 0) return value.of(shown, taught);
  std::vector<ConstraintSet> taken;
  ConstraintSet all, missed;
  for (const auto& conveyed : shown) {
    auto& own = taken.emplace_back();
    for (const auto c : in_order(cache.constraints(), conveyed)) {
      if (!all.contains(c) && all.count() == capacity) {
        missed.insert(c);
      } else {
        all.insert(c);
        own.insert(c);
      }
    }
  }
  return value.of(taken, taught.without(missed));
}

}  // namespace

Unit plan_unit(TeachingCache& cache, const TeachingView& view, UnitValue& value, const ImaginedPeople& people,
               const PlanOptions& options, RandomStream random) {
  const auto& atlas = view.atlas;
  const auto& component = atlas.knowledge_components()[view.component];
  VisitedStarts visited = view.visited;
  const auto candidates = candidates_of(cache, component, people.cells);
  Unit unit;
  auto region = cache.numbers_of(view.taught_region);
  std::vector<ConstraintSet> shown;
  std::optional<WorthOfImitation> imitation;
  if (value.imitation().probability > 0.0) imitation.emplace(cache.imitation(), value, view.history);
  double reached = 0.0;
  for (std::uint64_t step = 0; step < options.max_demonstrations && !candidates.empty(); ++step) {
    std::vector<double> values;
    TaughtAfter taught{cache, shown};
    std::vector<WorthOfImitation::Best> copied;
    shown.emplace_back();
    for (const auto& candidate : candidates) {
      shown.back() = candidate.conveyed;
      values.push_back(value_of_shown(cache, value, shown, taught.with(candidate.conveyed), options.capacity));
      if (!imitation) continue;
      copied.push_back(imitation->best_of(atlas, candidate.classes, visited));
      values.back() += copied.back().worth;
    }
    const double best = *std::max_element(values.begin(), values.end());
    if (step > 0 && !(best > reached + options.min_gain)) break;
    reached = best;
    std::vector<StartClassIndex> classes;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (values[i] < best - kTie) continue;
      classes.insert(classes.end(), candidates[i].classes.begin(), candidates[i].classes.end());
    }
    std::sort(classes.begin(), classes.end());
    const bool is_new =
        std::any_of(classes.begin(), classes.end(), [&](auto c) { return has_unvisited(atlas, c, visited); });
    const VisitedStarts nothing{atlas.num_states()};
    Demonstration next;
    if (imitation) {
      const auto first = std::max_element(values.begin(), values.end()) - values.begin();
      next.demo = copied[static_cast<std::size_t>(first)].demo;
      imitation->add(next.demo);
    } else {
      next.demo = simplest_of(atlas, classes, is_new ? visited : nothing, unit.demonstrations, random.split(step));
    }
    const auto chosen = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
      const auto c = atlas.start_class(next.demo);
      return std::find(candidate.classes.begin(), candidate.classes.end(), c) != candidate.classes.end();
    });
    shown.back() = chosen->conveyed;
    const auto effect = cache.regions().effect(region, chosen->conveyed);
    next.gain = effect.gain;
    next.num_new = effect.num_new;
    next.half_spaces = cache.constraints().half_spaces(chosen->conveyed);
    next.counterfactuals = people.weights;
    region = cache.regions().minimal(region | chosen->conveyed);
    visited.insert(next.demo);
    unit.demonstrations.push_back(std::move(next));
  }
  unit.taught_region = cache.constraints().half_spaces(region);
  return unit;
}

Unit unit_of(TeachingCache& cache, const TeachingView& view, std::span<const StartIndex> demonstrations,
             const ImaginedPeople& people) {
  Unit unit;
  auto region = cache.numbers_of(view.taught_region);
  for (const auto demo : demonstrations) {
    const auto conveyed = cache.regions().minimal(cache.behaviours().conveyed(demo, people.cells));
    if (conveyed.empty()) continue;
    const auto effect = cache.regions().effect(region, conveyed);
    unit.demonstrations.push_back({.demo = demo,
                                   .half_spaces = cache.constraints().half_spaces(conveyed),
                                   .gain = effect.gain,
                                   .num_new = effect.num_new,
                                   .counterfactuals = people.weights});
    region = cache.regions().minimal(region | conveyed);
  }
  unit.taught_region = cache.constraints().half_spaces(region);
  return unit;
}

double value_of(TeachingCache& cache, UnitValue& value, const Unit& unit, std::size_t capacity) {
  std::vector<ConstraintSet> shown;
  for (const auto& demonstration : unit.demonstrations) shown.push_back(cache.numbers_of(demonstration.half_spaces));
  ConstraintSet all;
  for (const auto& conveyed : shown) all |= conveyed;
  return value_of_shown(cache, value, shown, TaughtAfter{cache, {}}.with(all), capacity);
}

}  // namespace kith
