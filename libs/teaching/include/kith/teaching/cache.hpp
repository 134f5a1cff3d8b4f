#pragma once

#include <cstddef>
#include <list>
#include <memory>

#include "kith/bec/behaviours.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// What sessions over one domain compute again and again: regions of constraint
/// sets, what people do and what demonstrations tell them, and the initial points of beliefs.
///
/// Caches in front of pure functions: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The atlas must outlive it.
/// Sets of constraints are numbered by this cache: do not mix those of several.
class TeachingCache {
 public:
  explicit TeachingCache(const Atlas& atlas) : known_{std::make_unique<Known>(atlas)} {}

  [[nodiscard]] Behaviours& behaviours() noexcept { return known_->behaviours; }
  [[nodiscard]] Regions& regions() noexcept { return known_->regions; }
  [[nodiscard]] const ConstraintTable& constraints() const noexcept { return known_->behaviours.constraints(); }

  /// Forgets what was remembered if it has become much, as where behaviours are planned on demand every team meets new
  /// weights. Between sessions: none that uses this cache may go on afterwards.
  void trim();

  /// The cover of `prior` by `num_points` points. The reference stays valid as long as this object.
  const PriorCover& cover(const Cone& prior, std::size_t num_points);

 private:
  struct Known {
    explicit Known(const Atlas& atlas) : behaviours{atlas}, regions{behaviours.constraints()} {}
    Behaviours behaviours;
    Regions regions;
  };
  std::unique_ptr<Known> known_;
  std::list<PriorCover> covers_;  // few: one per prior and filter size of a study
};

}  // namespace kith
