#pragma once

#include <unordered_map>

#include "kith/bec/constraint_table.hpp"

namespace kith {

/// The region of weights that a set of constraints leaves.
struct Region {
  ConstraintSet minimal;  ///< The irredundant constraints; the whole set if the region has no interior.
  double area_sr = 0.0;   ///< Solid angle in steradian, in [0, 4 pi]; 0 without interior.
};

/// Minimal sets and areas by constraint set, each computed once: teaching asks
/// for the same few hundred again and again.
///
/// A cache in front of a pure function: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The table must outlive it.
class Regions {
 public:
  explicit Regions(const ConstraintTable& table) : table_{&table} {}

  /// The region of the intersection of `set`; the empty set is the whole sphere.
  /// The reference stays valid as long as this object.
  const Region& of(const ConstraintSet& set);

  [[nodiscard]] std::size_t size() const noexcept { return known_.size(); }

 private:
  const ConstraintTable* table_;
  std::unordered_map<ConstraintSet, Region> known_;
};

}  // namespace kith
