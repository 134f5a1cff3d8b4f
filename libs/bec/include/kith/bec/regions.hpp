#pragma once

#include <cstddef>
#include <list>
#include <optional>
#include <unordered_map>
#include <utility>

#include "kith/bec/constraint_table.hpp"
#include "kith/geometry/cloud.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// The region of weights that a set of constraints leaves.
struct Region {
  ConstraintSet minimal;    ///< The irredundant constraints; the whole set if the region has no interior.
  double area_sr = 0.0;     ///< Area on the unit sphere, steradian for d = 3; 0 without interior.
  double area_error = 0.0;  ///< Its standard error; 0 for d = 2 and 3.
};

/// What adding constraints to a region does.
struct RegionEffect {
  double gain = 1.0;        ///< Area before / after, >= 1.
  std::size_t num_new = 0;  ///< Facets of what is left that the region did not have.
};

/// Minimal sets and areas by constraint set, each computed once: teaching asks
/// for the same few hundred again and again.
///
/// A cache in front of a pure function: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The table must outlive it; it may grow.
class Regions {
 public:
  explicit Regions(const ConstraintTable& table) : table_{&table} {}
  ~Regions() = default;
  Regions(const Regions&) = delete;
  Regions& operator=(const Regions&) = delete;

  /// The region of the intersection of `set`; the empty set is the whole sphere.
  /// The reference stays valid as long as this object.
  const Region& of(const ConstraintSet& set);
  /// Region::minimal alone, which above three dimensions is much cheaper than the area.
  const ConstraintSet& minimal(const ConstraintSet& set);

  /// What `added` does to the region of `taught`, which is minimal and has interior. Exact up to three dimensions;
  /// above, areas are compared on the same 4 096 points that cover the taught region, so that a gain below 1 + 1 / 4096
  /// counts as none, and a constraint is new if it cuts off some of the points that the others leave.
  RegionEffect effect(const ConstraintSet& taught, const ConstraintSet& added);

  [[nodiscard]] std::size_t size() const noexcept { return known_.size(); }
  /// About how much is remembered, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept;

 private:
  // What `added` does is asked of one taught region many times over.
  struct Comparison {
    Comparison(ConstraintSet taught_region, Cloud points)
        : taught{std::move(taught_region)}, cloud{std::move(points)} {}
    ConstraintSet taught;
    Cloud cloud;
    std::unordered_map<ConstraintIndex, Cloud::Mask> masks;
  };
  [[nodiscard]] std::optional<Cone> cone_of(const ConstraintSet& set) const;
  [[nodiscard]] RegionEffect compare(const ConstraintSet& taught, const ConstraintSet& added);
  Comparison& comparison_with(const ConstraintSet& taught);

  const ConstraintTable* table_;
  std::unordered_map<ConstraintSet, Region> known_;
  const std::pair<const ConstraintSet, Region>* taught_ = nullptr;  // the last one that effect() was asked of
  std::unordered_map<ConstraintSet, ConstraintSet> minimal_;        // above three dimensions
  std::list<Comparison> comparisons_;                               // the last few, the latest first
};

}  // namespace kith
