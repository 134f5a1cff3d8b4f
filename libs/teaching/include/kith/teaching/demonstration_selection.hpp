#pragma once

#include <span>
#include <vector>

#include "kith/teaching/cache.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/visited_demos.hpp"

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
};

/// A unit: demonstrations that are shown together.
struct Unit {
  std::vector<Demonstration> demonstrations;
  std::vector<PolicyCellIndex> counterfactuals;  ///< Of the first selection.
  ConstraintSet taught_region;                   ///< R_n after the unit, minimal.
};

/// The policy cells of N beliefs drawn from `belief`; ascending, each once.
[[nodiscard]] std::vector<PolicyCellIndex> sample_counterfactuals(Behaviours& behaviours, const ParticleBelief& belief,
                                                                  const SelectionOptions& options, RandomStream random);

/// Chooses demonstrations for a belief until none adds knowledge.
///
/// Each step samples counterfactual beliefs from the belief as the unit would
/// leave it; candidate (M, s) conveys D = union over them of mu_robot - mu_learner
/// along the robot's path; its gain is area(R_n) / area(R_n with D). Among
/// unvisited candidates with gain > 1 the fewest new facets come first (few new
/// facts at once), then the largest gain, then the simplest and most similar
/// pictures, then chance [jayaraman2024, section III-D].
///
/// @param cache  of this atlas; it influences nothing.
/// @param belief  a copy, which learns along.
/// @param taught_region  R_n, minimal, with the prior.
/// @param visited  chosen ones are added.
[[nodiscard]] Unit select_demonstrations(const Atlas& atlas, TeachingCache& cache, ParticleBelief belief,
                                         const KnowledgeComponent& component, ConstraintSet taught_region,
                                         VisitedDemos& visited, const SelectionOptions& options, RandomStream random);

}  // namespace kith
