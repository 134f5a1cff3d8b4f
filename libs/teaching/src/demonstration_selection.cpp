#include "kith/teaching/demonstration_selection.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "imagined_people.hpp"
#include "kith/core/assert.hpp"
#include "kith/geometry/cover.hpp"
#include "visual_order.hpp"
#include "whole_components.hpp"

namespace kith {
namespace {

// Areas within this relative distance count as equal, so that rounding neither
// invents a gain nor breaks a tie.
constexpr double kGainTolerance = 1e-6;
constexpr double kTieTolerance = 1e-5;

// Whether what is added makes the taught region smaller.
bool adds(TeachingCache& cache, const ConstraintSet& taught, const ConstraintSet& added) {
  return cache.regions().effect(taught, added).gain > 1.0 + kGainTolerance;
}

// What showing any demonstration of one class would do to the taught region.
struct Prospect {
  StartClassIndex start_class;
  double gain = 1.0;
  std::size_t num_new = 0;
};

// What the rows of one selection would do, found by the row: most classes share theirs with others.
class Effects {
 public:
  // Forgets everything; at most `most` different rows come next, of `words` words each.
  void restart(std::size_t words, std::size_t most) {
    words_ = words;
    entries_.clear();
    slots_.assign(std::bit_ceil(2 * most + 1), kEmpty);
  }

  // The row's effect, from `compute` when it is met for the first time. The row's words must stay where they are.
  template <typename Compute>
  const RegionEffect& of(const std::uint64_t* row, Compute compute) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_words({row, words_}) & mask;
    while (slots_[slot] != kEmpty) {
      const Entry& known = entries_[slots_[slot]];
      if (is_same(row, known.row)) return known.effect;
      slot = (slot + 1) & mask;
    }
    slots_[slot] = static_cast<std::uint32_t>(entries_.size());
    return entries_.emplace_back(Entry{row, compute()}).effect;
  }

 private:
  struct Entry {
    const std::uint64_t* row;
    RegionEffect effect;
  };
  // Few words: a call would take longer than to compare them.
  [[nodiscard]] bool is_same(const std::uint64_t* a, const std::uint64_t* b) const {
    std::uint64_t differs = 0;
    for (std::size_t i = 0; i < words_; ++i) differs |= a[i] ^ b[i];
    return differs == 0;
  }

  static constexpr std::uint32_t kEmpty = 0xFFFFFFFF;
  std::size_t words_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> slots_;  // open addressing
};

class Selection {
 public:
  Selection(TeachingCache& cache, const KnowledgeComponent& component, const VisitedStarts& visited)
      : atlas_{cache.atlas()}, cache_{cache}, component_{component}, visited_{visited} {}

  // The next demonstration of the unit, or nothing if none has gain.
  std::optional<Demonstration> next(std::span<const PolicyCellIndex> cells, const ConstraintSet& taught_region,
                                    const std::vector<Demonstration>& unit, const RandomStream& random) {
    conveyed_ = cache_.behaviours().conveyed_by_class(component_, cells);
    return best_of_all(taught_region, unit, random);
  }

  // The same for people who expect no end, where there are no tables: what is conveyed is that of these facets which
  // single deviations from the path show, such as one step of going round for ever.
  std::optional<Demonstration> next_for_the_endless(const ConstraintSet& facets, const ConstraintSet& taught_region,
                                                    const std::vector<Demonstration>& unit,
                                                    const RandomStream& random) {
    constexpr std::size_t kBits = 64;
    const std::size_t words = (cache_.constraints().size() + kBits - 1) / kBits;
    rows_.assign(atlas_.num_start_classes() * words, 0);
    for (const auto c : component_.start_classes) {
      const auto& shown = atlas_.one_step(atlas_.members(c).front());
      for (const auto facet : facets.members()) {
        if (!shown.contains(facet)) continue;
        rows_[c.value() * words + facet.value() / kBits] |= std::uint64_t{1} << (facet.value() % kBits);
      }
    }
    conveyed_ = {words, rows_, {}};
    return best_of_all(taught_region, unit, random);
  }

 private:
  std::optional<Demonstration> best_of_all(const ConstraintSet& taught_region, const std::vector<Demonstration>& unit,
                                           const RandomStream& random) {
    auto prospects = prospects_with_gain(taught_region);
    // Fewest new facets first, then the best gain; classes whose members were all visited do not count.
    std::erase_if(prospects, [&](const Prospect& p) { return !has_unvisited(atlas_, p.start_class, visited_); });
    if (prospects.empty()) return std::nullopt;
    const auto fewest = std::min_element(prospects.begin(), prospects.end(), [](const Prospect& a, const Prospect& b) {
                          return a.num_new < b.num_new;
                        })->num_new;
    std::erase_if(prospects, [&](const Prospect& p) { return p.num_new != fewest; });
    const auto best = std::max_element(prospects.begin(), prospects.end(), [](const Prospect& a, const Prospect& b) {
                        return a.gain < b.gain;
                      })->gain;
    std::erase_if(prospects, [&](const Prospect& p) { return p.gain < best * (1.0 - kTieTolerance); });
    return simplest(prospects, unit, random);
  }

  std::vector<Prospect> prospects_with_gain(const ConstraintSet& taught_region) {
    std::vector<Prospect> prospects;
    const std::size_t words = conveyed_.words;
    effects_.restart(words, component_.start_classes.size());
    for (const auto c : component_.start_classes) {
      const std::uint64_t* const row = conveyed_.rows.data() + c.value() * words;
      if (std::all_of(row, row + words, [](std::uint64_t word) { return word == 0; })) continue;
      const auto& effect = effects_.of(row, [&] { return cache_.regions().effect(taught_region, conveyed_.set(c)); });
      if (effect.gain > 1.0 + kGainTolerance) prospects.push_back({c, effect.gain, effect.num_new});
    }
    return prospects;
  }

  Demonstration simplest(std::span<const Prospect> prospects, const std::vector<Demonstration>& unit,
                         const RandomStream& random) {
    std::vector<StartClassIndex> classes;
    classes.reserve(prospects.size());
    for (const auto& prospect : prospects) classes.push_back(prospect.start_class);
    Demonstration best;
    best.start = simplest_of(atlas_, classes, visited_, unit, random);
    const auto chosen = std::find_if(prospects.begin(), prospects.end(), [&](const Prospect& prospect) {
      return prospect.start_class == atlas_.start_class(best.start);
    });
    best.gain = chosen->gain;
    best.num_new = chosen->num_new;
    best.half_spaces =
        cache_.constraints().half_spaces(cache_.regions().minimal(conveyed_.set(atlas_.start_class(best.start))));
    return best;
  }

  const Atlas& atlas_;
  TeachingCache& cache_;
  const KnowledgeComponent& component_;
  const VisitedStarts& visited_;
  Behaviours::Conveyed conveyed_;
  std::vector<std::uint64_t> rows_;  // of next_for_the_endless()
  Effects effects_;
};

std::vector<std::size_t> sampled_particles(const ParticleBelief& belief, const SelectionOptions& options,
                                           RandomStream random) {
  std::vector<std::size_t> particles;
  if (options.sampling == CounterfactualSampling::kSystematic) {
    for (const auto& draw : belief.systematic_draws(options.counterfactuals, random)) particles.push_back(draw.index);
    return particles;
  }
  Eigen::MatrixXd points(static_cast<Eigen::Index>(belief.dimension()), static_cast<Eigen::Index>(belief.size()));
  for (std::size_t i = 0; i < belief.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = belief.point(i);
  const auto weights = belief.weights();
  const auto heaviest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  return k_centres(points, std::min(options.counterfactuals, belief.size()), heaviest);
}

}  // namespace

std::vector<PolicyCellIndex> sample_counterfactuals(Behaviours& behaviours, const ParticleBelief& belief,
                                                    const SelectionOptions& options, RandomStream random,
                                                    std::vector<std::size_t>* particles) {
  const auto drawn = sampled_particles(belief, options, random);
  std::vector<std::pair<PolicyCellIndex, std::size_t>> found;  // cell, place among the draws
  found.reserve(drawn.size());
  for (std::size_t place = 0; place < drawn.size(); ++place) {
    found.emplace_back(behaviours.locate(belief.point(drawn[place])), place);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
              found.end());
  std::vector<PolicyCellIndex> cells;
  cells.reserve(found.size());
  for (const auto& [cell, place] : found) cells.push_back(cell);
  if (particles != nullptr) {
    for (const auto& [cell, place] : found) particles->push_back(place);
    std::sort(particles->begin(), particles->end());
    for (auto& place : *particles) place = drawn[place];
  }
  return cells;
}

Unit select_demonstrations(TeachingCache& cache, const ParticleBelief& belief, const KnowledgeComponent& component,
                           std::span<const HalfSpace> taught_region, VisitedStarts visited,
                           const SelectionOptions& options, RandomStream random) {
  Unit unit;
  ConstraintSet taught = cache.numbers_of(taught_region);
  Selection selection{cache, component, visited};
  std::vector<std::size_t> particles;
  std::optional<ParticleBelief> expected;  // once something is shown
  const std::size_t most = options.max_demonstrations;
  for (std::uint64_t step = 0; most == 0 || step < most; ++step) {
    if (component.conveyed && !adds(cache, taught, *component.conveyed)) break;  // nobody can be told anything new
    if (step > 0) {
      if (!expected) expected = belief;
      expected->observe(unit.demonstrations.back().half_spaces, options.likelihood,
                        random.split(step - 1).split("copy"));
    }
    const auto& now = expected ? *expected : belief;
    const auto here = random.split(step);
    particles.clear();
    const auto cells =
        sample_counterfactuals(cache.behaviours(), now, options, here.split("counterfactuals"), &particles);
    auto next = selection.next(cells, taught, unit.demonstrations, here.split("looks"));
    if (!next) break;
    next->counterfactuals.reserve(particles.size());
    for (const auto i : particles) next->counterfactuals.push_back(now.point(i));
    visited.insert(next->start);
    taught = cache.regions().minimal(taught | cache.numbers_of(next->half_spaces));
    unit.demonstrations.push_back(std::move(*next));
  }
  unit.taught_region = cache.constraints().half_spaces(taught);
  return unit;
}

ConstraintSet open_facets(TeachingCache& cache, const ConstraintSet& facets, const ConstraintSet& shown) {
  ConstraintSet open;
  for (const auto facet : facets.without(shown).members()) {
    ConstraintSet alone;
    alone.insert(facet);
    if (adds(cache, shown, alone)) open.insert(facet);
  }
  return open;
}

namespace {

// How people miss what is open; each way only where no demonstration tells those of the one before anything. The first
// are the same in all sessions, so that their behaviours are known.
enum class Missed {
  kComponent,   // facets of the component's region, whatever was shown
  kWhatIsLeft,  // facets of what it leaves of that
  kNearly,      // these, by less
  kAnywhere,    // anything
};
constexpr std::array kMissed{Missed::kComponent, Missed::kWhatIsLeft, Missed::kNearly, Missed::kAnywhere};
constexpr double kNearMiss = 0.02;    // see near_misses()
constexpr std::size_t kAnybody = 32;  // who cover what was left before

// People who miss what is open of a component. Nobody if nothing is open.
ImaginedPeople who_miss(TeachingCache& cache, const KnowledgeComponent& component, const ConstraintSet& shown,
                        Missed how) {
  ImaginedPeople people;
  const auto& known = how == Missed::kComponent ? cache.atlas().prior() : shown;
  const auto left = cache.regions().minimal(known | component.constraints);
  const auto open = open_facets(cache, left, shown);
  if (open.empty()) return people;
  if (how == Missed::kAnywhere) {
    Cone region{cache.atlas().domain().num_features()};  // nothing may have been shown, and nothing be known before
    const bool has_room = region.clip(cache.constraints().half_spaces(shown));
    KITH_ASSERT(has_room);  // the robot's weights lie inside
    const Eigen::MatrixXd anybody = cover(region, kAnybody, cache.atlas().feature_order());
    for (Eigen::Index i = 0; i < anybody.cols(); ++i) people.add(cache.behaviours(), anybody.col(i));
  } else {
    imagine_near_misses(cache, left, open, how == Missed::kNearly ? kNearMiss : kMiss, people);
  }
  return people;
}

}  // namespace

void complete_unit(TeachingCache& cache, Unit& unit, const KnowledgeComponent& component,
                   std::span<const HalfSpace> shown_before, VisitedStarts visited, const SelectionOptions& options,
                   RandomStream random) {
  auto& regions = cache.regions();
  auto taught = regions.minimal(cache.numbers_of(unit.taught_region));
  auto shown = regions.minimal(taught | cache.numbers_of(shown_before));
  for (const auto& demonstration : unit.demonstrations) visited.insert(demonstration.start);
  const VisitedStarts nothing{cache.atlas().num_states()};
  Selection fresh{cache, component, visited};
  Selection any{cache, component, nothing};
  const std::size_t most = options.max_demonstrations;
  for (std::uint64_t step = 0; most == 0 || unit.demonstrations.size() < most; ++step) {
    std::optional<Demonstration> next;
    ImaginedPeople people;
    for (const bool again : {false, true}) {
      for (const auto how : kMissed) {
        people = who_miss(cache, component, shown, how);
        if (people.cells.empty()) break;
        next = (again ? any : fresh).next(people.cells, shown, unit.demonstrations, random.split(step));
        if (!next && !options.avoids_repeats) {
          next = any.next(people.cells, shown, unit.demonstrations, random.split(step));
        }
        if (next) break;
      }
      if (next || people.cells.empty()) break;
    }
    if (!next && !people.cells.empty() && teaches_whole_components(cache.atlas())) {
      const auto open = open_facets(cache, component.constraints, shown);
      people = who_miss(cache, component, shown, Missed::kComponent);
      next = fresh.next_for_the_endless(open, shown, unit.demonstrations, random.split(step));
      if (!next) next = any.next_for_the_endless(open, shown, unit.demonstrations, random.split(step));
    }
    if (!next) break;
    const auto conveyed = cache.numbers_of(next->half_spaces);
    const auto effect = regions.effect(taught, conveyed);
    next->gain = effect.gain;
    next->num_new = effect.num_new;
    next->counterfactuals = std::move(people.weights);
    next->completes = true;
    visited.insert(next->start);
    taught = regions.minimal(taught | conveyed);
    shown = regions.minimal(shown | conveyed);
    unit.demonstrations.push_back(std::move(*next));
  }
  unit.taught_region = cache.constraints().half_spaces(taught);
}

Unit UnitSelector::for_belief(const ParticleBelief& belief, RandomStream random) {
  const auto& component = view_->atlas.knowledge_components()[view_->component];
  auto unit = select_demonstrations(*cache_, belief, component, view_->taught_region, view_->visited, options_,
                                    random.split("new"));
  if (unit.demonstrations.empty() || teaches_whole_components(view_->atlas)) complete(unit, random.split("open"));
  if (unit.demonstrations.empty() && view_->last_of_component != nullptr) {
    unit = select_demonstrations(*cache_, belief, component, view_->taught_region,
                                 VisitedStarts{view_->atlas.num_states()}, options_, random.split("again"));
  }
  return unit;
}

void UnitSelector::complete(Unit& unit, RandomStream random) {
  std::vector<HalfSpace> shown;
  for (auto past = view_->history.end(); past != view_->history.begin();) {
    const auto& lesson = (--past)->lesson;
    if (lesson.component != view_->component) break;
    shown.insert(shown.end(), lesson.taught.begin(), lesson.taught.end());
  }
  if (unit.demonstrations.empty()) unit.taught_region.assign(view_->taught_region.begin(), view_->taught_region.end());
  complete_unit(*cache_, unit, view_->atlas.knowledge_components()[view_->component], shown, view_->visited, options_,
                random);
}

}  // namespace kith
