#pragma once

#include <span>
#include <vector>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {

/// How beliefs are sampled from a particle belief when demonstrations are chosen.
enum class CounterfactualSampling {
  kSystematic,  ///< One systematic pass over the weights.
  kSpread,      ///< Greedy k-centres from the heaviest particle: always reaches the rim of the cloud.
};

struct SelectionOptions {
  std::size_t counterfactuals = 8;  ///< N >= 1 beliefs per selection.
  CounterfactualSampling sampling = CounterfactualSampling::kSystematic;
  HalfSpaceLikelihood likelihood{0.8};  ///< How the copy of the belief learns from the unit's demonstrations.
  std::size_t max_demonstrations = 0;   ///< Per unit; 0: as many as have gain.
  bool avoids_repeats = true;           ///< TeachingOptions::avoids_repeats
};

/// The policy cells of N beliefs drawn from `belief`; ascending, each once.
/// @param particles  if not null, gets the first particle drawn of each cell, in the order of the draws.
[[nodiscard]] std::vector<PolicyCellIndex> sample_counterfactuals(Behaviours& behaviours, const ParticleBelief& belief,
                                                                  const SelectionOptions& options, RandomStream random,
                                                                  std::vector<std::size_t>* particles = nullptr);

/// Chooses demonstrations for a belief until none adds knowledge.
///
/// Each step samples counterfactual beliefs from the belief as the unit would
/// leave it; candidate (M, s) conveys D = union over them of mu_robot - mu_learner
/// along the robot's path; its gain is area(R_n) / area(R_n with D). Among
/// unvisited candidates with gain > 1 the fewest new facets come first (few new
/// facts at once), then the largest gain, then the simplest and most similar
/// pictures, then chance [jayaraman2024, section III-D].
///
/// @param cache  makes it faster and changes no result.
/// @param belief  of which a copy learns along.
/// @param taught_region  R_n, minimal, with the prior.
/// @param visited  what may not be chosen.
/// @return the unit; without demonstrations if none has gain.
[[nodiscard]] Unit select_demonstrations(TeachingCache& cache, const ParticleBelief& belief,
                                         const KnowledgeComponent& component, std::span<const HalfSpace> taught_region,
                                         VisitedStarts visited, const SelectionOptions& options, RandomStream random);

/// Adds demonstrations of what is still open: of the facets of the component's region that neither the unit nor what
/// was shown before implies, whatever people believe. They are chosen by the same rule for somebody who only just
/// misses each of these facets (near_misses()); what was not met yet comes first. Where behaviours are not tabulated,
/// those who then expect no end are told the facets among Atlas::one_step(). Afterwards nothing that could be shown
/// cuts what is left any further, unless the limit ends the unit before.
///
/// @param unit  with its taught_region, from which teaching begins if it has no demonstrations.
/// @param shown_before  by other lessons of the component. @param visited  before the unit.
/// @param options  its max_demonstrations and avoids_repeats.
void complete_unit(TeachingCache& cache, Unit& unit, const KnowledgeComponent& component,
                   std::span<const HalfSpace> shown_before, VisitedStarts visited, const SelectionOptions& options,
                   RandomStream random);

/// What a strategy chooses demonstrations with: select_demonstrations() with the options, the component, the region
/// and the history of a session.
class UnitSelector {
 public:
  UnitSelector(TeachingCache& cache, const TeachingView& view, const SelectionOptions& options)
      : cache_{&cache}, view_{&view}, options_{options} {}

  /// The best unit for a belief among what was not shown before; completed (see complete()) if it is empty and, where
  /// behaviours are not tabulated and lessons examine the whole component, in any case; if it still is empty and the
  /// component is under way, the best unit among everything. Without demonstrations if none has gain. Each call within
  /// a proposal needs a stream of its own.
  [[nodiscard]] Unit for_belief(const ParticleBelief& belief, RandomStream random);

  /// complete_unit() for the session: earlier lessons of the component count as shown.
  void complete(Unit& unit, RandomStream random);

  /// For strategies that choose by a rule of their own: what people would do, and regions of constraints.
  [[nodiscard]] TeachingCache& cache() noexcept { return *cache_; }
  [[nodiscard]] const SelectionOptions& options() const noexcept { return options_; }

 private:
  TeachingCache* cache_;
  const TeachingView* view_;
  SelectionOptions options_;
};

}  // namespace kith
