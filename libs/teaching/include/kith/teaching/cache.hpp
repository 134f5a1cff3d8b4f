#pragma once

#include <cstddef>
#include <list>

#include "kith/bec/regions.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// What sessions over one domain compute again and again: regions of constraint
/// sets and the initial points of beliefs.
///
/// Caches in front of pure functions: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The constraint table must
/// outlive it.
class TeachingCache {
 public:
  explicit TeachingCache(const ConstraintTable& constraints) : regions_{constraints} {}

  [[nodiscard]] Regions& regions() noexcept { return regions_; }

  /// The cover of `prior` by `num_points` points. The reference stays valid as long as this object.
  const PriorCover& cover(const Cone& prior, std::size_t num_points);

 private:
  Regions regions_;
  std::list<PriorCover> covers_;  // few: one per prior and filter size of a study
};

}  // namespace kith
