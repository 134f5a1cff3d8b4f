#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/constraint_set.hpp"
#include "kith/geometry/half_space.hpp"

namespace kith {

/// The distinct half-spaces that matter in one domain, numbered in order of first use.
class ConstraintTable {
 public:
  /// @param dimension d, the number of reward features.
  explicit ConstraintTable(std::size_t dimension = 3) : dimension_{dimension} {}

  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }
  /// The number of `half_space`, which is added if it is new.
  ConstraintIndex add(const HalfSpace& half_space);

  [[nodiscard]] std::size_t size() const noexcept { return half_spaces_.size(); }
  [[nodiscard]] const HalfSpace& operator[](ConstraintIndex c) const { return half_spaces_[c.value()]; }
  [[nodiscard]] std::optional<ConstraintIndex> find(const HalfSpace& half_space) const;

  /// The half-spaces of a set, sorted lexicographically by normal.
  [[nodiscard]] std::vector<HalfSpace> half_spaces(const ConstraintSet& set) const;
  /// The set of these half-spaces. @throws std::invalid_argument if one is not in the table.
  [[nodiscard]] ConstraintSet set_of(std::span<const HalfSpace> half_spaces) const;

 private:
  std::size_t dimension_;
  std::vector<HalfSpace> half_spaces_;
  std::unordered_map<HalfSpace, ConstraintIndex> index_;
};

}  // namespace kith
