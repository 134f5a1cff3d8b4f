#pragma once

#include <span>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {

// Whom demonstrations are imagined to be shown to.
struct ImaginedPeople {
  std::vector<PolicyCellIndex> cells;  // ascending, each once
  std::vector<Direction> weights;      // one per cell, in the order of the draws

  // Somebody more, unless somebody is there already who acts alike.
  void add(Behaviours& behaviours, const Direction& person);
};

struct NumImagined {
  std::size_t prior = 0;
  std::size_t beliefs = 0;
};

// Systematic draws from the prior and from the beliefs together, each belief weighing the same.
// @param prior_offset  of the draws from the prior, in [0, 1); with the same one the same people are drawn.
// @param beliefs  in an order that does not depend on seats. Not empty.
[[nodiscard]] ImaginedPeople imagine_people(TeachingCache& cache, std::span<const ParticleBelief* const> beliefs,
                                            const NumImagined& n, double prior_offset, RandomStream random);

// What is open of `facets` where `shown`, which is minimal, is known.
[[nodiscard]] ConstraintSet open_facets(TeachingCache& cache, const ConstraintSet& facets, const ConstraintSet& shown);

// Adds, for each of these facets of the region of a set of constraints, somebody who only just misses it
// (near_misses()) and is right about everything else. What is conveyed to them is the facet itself, which people who
// know nothing, or nearly everything, may not bring up.
void imagine_near_misses(TeachingCache& cache, const ConstraintSet& region, const ConstraintSet& facets, double miss,
                         ImaginedPeople& people);

// How far they miss it as a rule.
inline constexpr double kMiss = 0.5;

}  // namespace kith
