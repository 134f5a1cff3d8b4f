#include "hull_pruner.hpp"

#include <algorithm>

namespace kith::detail {
namespace {

constexpr std::size_t kMostWitnesses = 32;

Counts to_counts(const IntegerVector& v) { return {v[0], v[1], v[2]}; }

Int128 dot(const Counts& a, const Counts& b) {
  return static_cast<Int128>(a[0]) * b[0] + static_cast<Int128>(a[1]) * b[1] + static_cast<Int128>(a[2]) * b[2];
}

}  // namespace

HullPruner::HullPruner(const Cone& region) : region_{region} {
  for (const IntegerVector& g : region.generators()) generators_.push_back(to_counts(g));
  witnesses_ = generators_;
  witnesses_.push_back(to_counts(region.interior_direction()));
}

bool HullPruner::dominates(const Counts& a, const Counts& b) const {
  const Counts gap = difference(a, b);
  return std::ranges::all_of(generators_, [&](const Direction& g) { return dot(gap, g) >= 0; });
}

bool HullPruner::merge(std::vector<Counts>& set, const Counts& shift, std::span<const Counts> more) {
  const std::size_t old_size = set.size();
  std::vector<Counts> before;
  for (const Counts& v : more) {
    const Counts candidate = sum(v, shift);
    if (std::ranges::any_of(set, [&](const Counts& p) { return dominates(p, candidate); })) continue;
    if (before.empty()) before = set;
    std::erase_if(set, [&](const Counts& p) { return dominates(candidate, p); });
    set.push_back(candidate);
  }
  if (before.empty() && set.size() == old_size) return false;
  keep_vertices(set);
  return !std::ranges::is_permutation(set, before);
}

// Of two counts neither of which dominates the other, each is best somewhere.
void HullPruner::keep_vertices(std::vector<Counts>& set) {
  if (set.size() < 3) return;
  mark_witnessed(set);
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (is_vertex_[i] == 0 && has_own_cell(set, i)) is_vertex_[i] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (is_vertex_[i] != 0) set[kept++] = set[i];
  }
  set.resize(kept);
}

// A unique maximiser at a direction of the closed region is unique around it, so also somewhere in the interior.
void HullPruner::mark_witnessed(const std::vector<Counts>& set) {
  is_vertex_.assign(set.size(), 0);
  for (const Direction& w : witnesses_) {
    Int128 best = dot(set[0], w);
    std::size_t winner = 0;
    bool unique = true;
    for (std::size_t i = 1; i < set.size(); ++i) {
      const Int128 value = dot(set[i], w);
      if (value < best) continue;
      unique = value > best;
      if (unique) winner = i;
      best = value;
    }
    if (unique) is_vertex_[winner] = 1;
  }
}

// Whether some weights in the interior prefer set[i] strictly to all others.
bool HullPruner::has_own_cell(const std::vector<Counts>& set, std::size_t i) {
  std::optional<Cone> cell = region_;
  for (std::size_t j = 0; j < set.size() && cell; ++j) {
    if (j == i) continue;
    const Counts gap = difference(set[i], set[j]);
    cell = cell->clipped(HalfSpace{IntegerVector{gap[0], gap[1], gap[2]}});
  }
  if (cell && witnesses_.size() < kMostWitnesses) witnesses_.push_back(to_counts(cell->interior_direction()));
  return cell.has_value();
}

}  // namespace kith::detail
