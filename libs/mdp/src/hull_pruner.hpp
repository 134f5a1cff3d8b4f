#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"

namespace kith::detail {

// Feature counts in three dimensions, compactly.
using Counts = std::array<std::int64_t, 3>;

[[nodiscard]] inline Counts sum(const Counts& a, const Counts& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
[[nodiscard]] inline Counts difference(const Counts& a, const Counts& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Keeps sets of feature counts at their vertices as seen from a cone of
// weights: every member is the unique maximiser of w . v for some w in the
// interior. Exact: signs of 128-bit products, cells of weights by clipping.
class HullPruner {
 public:
  explicit HullPruner(const Cone& region);

  // Merges `more`, each moved by `shift`, into `set`. Whether `set` changed (its order may change in any case).
  bool merge(std::vector<Counts>& set, const Counts& shift, std::span<const Counts> more);

 private:
  using Direction = Counts;

  [[nodiscard]] bool dominates(const Counts& a, const Counts& b) const;
  void keep_vertices(std::vector<Counts>& set);
  void mark_witnessed(const std::vector<Counts>& set);
  [[nodiscard]] bool has_own_cell(const std::vector<Counts>& set, std::size_t i);

  Cone region_;
  std::vector<Direction> generators_;
  // Directions inside the region at which some vertex was the only maximiser: likely to tell others apart as well.
  std::vector<Direction> witnesses_;
  std::vector<unsigned char> is_vertex_;
};

}  // namespace kith::detail
