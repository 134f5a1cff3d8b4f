#include "kith/teaching/demonstration_selection.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "kith/core/assert.hpp"
#include "kith/geometry/cover.hpp"
#include "visual_order.hpp"

namespace kith {
namespace {

// Areas within this relative distance count as equal, so that rounding neither
// invents a gain nor breaks a tie.
constexpr double kGainTolerance = 1e-6;
constexpr double kTieTolerance = 1e-5;

// What showing any demonstration of one class would do to the taught region.
struct Prospect {
  DemoClassIndex demo_class;
  double gain = 1.0;
  std::size_t num_new = 0;
};

class Selection {
 public:
  Selection(const Atlas& atlas, Regions& regions, const KnowledgeComponent& component, std::vector<bool>& visited)
      : atlas_{atlas}, regions_{regions}, component_{component}, visited_{visited} {}

  // The next demonstration of the unit, or nothing if none has gain.
  std::optional<Demonstration> next(std::span<const PolicyCellIndex> cells, const ConstraintSet& taught_region,
                                    const std::vector<Demonstration>& unit, const RandomStream& random) {
    conveyed_ = atlas_.conveyed_by_class(cells);
    auto prospects = prospects_with_gain(taught_region);
    // Fewest new facets first, then the best gain; classes whose members were all visited do not count.
    std::erase_if(prospects, [&](const Prospect& p) { return !has_unvisited(p.demo_class); });
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

 private:
  [[nodiscard]] std::span<const std::uint64_t> row(DemoClassIndex c) const {
    const auto words = atlas_.words_per_set();
    return std::span{conveyed_}.subspan(c.value() * words, words);
  }

  std::vector<Prospect> prospects_with_gain(const ConstraintSet& taught_region) {
    std::vector<Prospect> prospects;
    const double area_before = regions_.of(taught_region).area_sr;
    for (DemoClassIndex c{0}; c.value() < atlas_.num_demo_classes(); ++c) {
      if (!atlas_.belongs_to(c, component_)) continue;
      union_ = taught_region;
      const auto conveyed = row(c);
      for (std::size_t i = 0; i < conveyed.size(); ++i) union_.words()[i] |= conveyed[i];
      if (union_ == taught_region) continue;
      const auto& region = regions_.of(union_);
      KITH_ASSERT(region.area_sr > 0.0);  // the robot's weights satisfy everything that is conveyed
      const double gain = area_before / region.area_sr;
      if (gain > 1.0 + kGainTolerance) prospects.push_back({c, gain, region.minimal.without(taught_region).count()});
    }
    return prospects;
  }

  [[nodiscard]] bool has_unvisited(DemoClassIndex c) const {
    const auto members = atlas_.members(c);
    return std::any_of(members.begin(), members.end(), [&](DemoIndex d) { return !visited_[d.value()]; });
  }

  Demonstration simplest(std::span<const Prospect> prospects, const std::vector<Demonstration>& unit,
                         const RandomStream& random) {
    std::optional<VisualKey> best_key;
    Demonstration best;
    for (const auto& prospect : prospects) {
      for (const auto demo : atlas_.members(prospect.demo_class)) {
        if (visited_[demo.value()]) continue;
        auto key = look(demo, unit);
        if (best_key && key > *best_key) continue;
        // Hashing is the costly part: only when everything else is equal.
        key.chance = chance_of(demo, random);
        if (best_key && key >= *best_key) continue;
        best_key = key;
        best.demo = demo;
        best.gain = prospect.gain;
        best.num_new = prospect.num_new;
      }
    }
    best.constraints = regions_.of(ConstraintSet{row(atlas_.demo_class(best.demo))}).minimal;
    best.half_spaces = atlas_.constraints().half_spaces(best.constraints);
    return best;
  }

  // Simple first; then like the last demonstration, or typical of its world if it opens the unit.
  [[nodiscard]] VisualKey look(DemoIndex demo, const std::vector<Demonstration>& unit) const {
    const auto id = atlas_.id(demo);
    const int dissimilarity =
        unit.empty() ? atlas_.mean_dissimilarity(demo) : atlas_.domain().dissimilarity(id, atlas_.id(unit.back().demo));
    return {atlas_.domain().complexity(id), dissimilarity, 0};
  }

  const Atlas& atlas_;
  Regions& regions_;
  const KnowledgeComponent& component_;
  std::vector<bool>& visited_;
  std::vector<std::uint64_t> conveyed_;
  ConstraintSet union_;
};

std::vector<std::size_t> sampled_particles(const ParticleBelief& belief, const SelectionOptions& options,
                                           RandomStream random) {
  std::vector<std::size_t> particles;
  if (options.sampling == CounterfactualSampling::kSystematic) {
    for (const auto& draw : belief.systematic_draws(options.counterfactuals, random)) particles.push_back(draw.index);
    return particles;
  }
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(belief.size()));
  for (std::size_t i = 0; i < belief.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = belief.point(i);
  const auto weights = belief.weights();
  const auto heaviest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  return k_centres(points, std::min(options.counterfactuals, belief.size()), heaviest);
}

}  // namespace

std::vector<PolicyCellIndex> sample_counterfactuals(const Atlas& atlas, const ParticleBelief& belief,
                                                    const SelectionOptions& options, RandomStream random) {
  std::vector<PolicyCellIndex> cells;
  for (const auto i : sampled_particles(belief, options, random))
    cells.push_back(atlas.cells().locate(belief.point(i)));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

Unit select_demonstrations(const Atlas& atlas, Regions& regions, ParticleBelief belief,
                           const KnowledgeComponent& component, ConstraintSet taught_region, std::vector<bool>& visited,
                           const SelectionOptions& options, RandomStream random) {
  Unit unit;
  unit.taught_region = std::move(taught_region);
  Selection selection{atlas, regions, component, visited};
  for (std::uint64_t step = 0;; ++step) {
    const auto here = random.split(step);
    const auto cells = sample_counterfactuals(atlas, belief, options, here.split("counterfactuals"));
    auto next = selection.next(cells, unit.taught_region, unit.demonstrations, here.split("looks"));
    if (!next) return unit;
    if (unit.demonstrations.empty()) unit.counterfactuals = cells;
    visited[next->demo.value()] = true;
    unit.taught_region = regions.of(unit.taught_region | next->constraints).minimal;
    belief.observe(next->half_spaces, options.likelihood, here.split("copy"));
    unit.demonstrations.push_back(std::move(*next));
  }
}

}  // namespace kith
