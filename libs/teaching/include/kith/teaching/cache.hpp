#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// What sessions over one domain compute again and again: regions of constraint
/// sets, what demonstrations convey, and the initial points of beliefs.
///
/// Caches in front of pure functions: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The constraint table must
/// outlive it.
class TeachingCache {
 public:
  explicit TeachingCache(const ConstraintTable& constraints) : regions_{constraints} {}

  [[nodiscard]] Regions& regions() noexcept { return regions_; }

  /// What demonstrations convey to people who hold weights of the given cells, as Atlas::conveyed_by_class tells it.
  /// Each cell is computed once; several are the union of their rows. @param atlas always the same one.
  /// The result stays valid until the next call. Shape [num_demo_classes, words_per_set()].
  std::span<const std::uint64_t> conveyed_by_class(const Atlas& atlas, std::span<const PolicyCellIndex> cells);

  /// The cover of `prior` by `num_points` points. The reference stays valid as long as this object.
  const PriorCover& cover(const Cone& prior, std::size_t num_points);

 private:
  Regions regions_;
  std::vector<std::vector<std::uint64_t>> conveyed_by_cell_;  // empty where not asked for yet
  std::vector<std::uint64_t> conveyed_;
  std::list<PriorCover> covers_;  // few: one per prior and filter size of a study
};

}  // namespace kith
