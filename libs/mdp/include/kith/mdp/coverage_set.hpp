#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/geometry/cone.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith {

/// The convex coverage sets of a deterministic, undiscounted, integral Mdp: for
/// each start state the feature counts of all trajectories that are optimal for
/// an open set of reward weights with a finite optimum (Barrett & Narayanan 2008,
/// Roijers et al. 2013). For every such w and every state s
///   V_w(s) = max { w . mu : mu in vertices(s) }.
class CoverageSets {
 public:
  /// The weights for which every optimum is finite: { w : w . c <= 0 for every cycle c }.
  /// In its interior all cycles lose. Nothing outside is covered.
  [[nodiscard]] const Cone& finite_region() const noexcept { return finite_region_; }
  /// Feature counts, sorted lexicographically. Every one is the unique optimum of some weight inside finite_region().
  /// @throws std::invalid_argument if s is terminal.
  [[nodiscard]] std::span<const IntegerVector> vertices(StateIndex s) const;
  /// Sum over non-terminal states of the number of vertices.
  [[nodiscard]] std::size_t num_vertices() const noexcept { return vertices_.size(); }

 private:
  friend class CoverageSolver;
  CoverageSets() = default;
  Cone finite_region_;
  std::vector<std::size_t> first_;  // shape [num_states + 1]
  std::vector<IntegerVector> vertices_;
};

/// Whether no path can count 2^31 of anything, which coverage_sets() asks for:
/// largest_feature() * (num_states() + 1) < 2^31.
[[nodiscard]] bool has_small_counts(const Mdp& mdp) noexcept;

/// Hull value iteration. The finite region is found first, exactly, by cutting
/// planes: Bellman-Ford on the generators of the current cone yields cycles that
/// still gain, and each cuts the cone. Then sets of feature counts are swept from
/// the terminal states, candidates phi + V(s') pruned to those optimal somewhere
/// inside the finite region, until nothing changes.
/// @throws std::invalid_argument unless the Mdp is deterministic, integral, undiscounted with three features,
/// or unless has_small_counts() and values stay in their exact range (2^60).
/// @throws kith::Error (kInfeasible) if the weights with a finite optimum have no interior, if the features of a cycle
/// sum to zero (it costs nothing under any weights), or if some state cannot reach a terminal one.
[[nodiscard]] CoverageSets coverage_sets(const Mdp& mdp);

/// The vectors that are the unique maximiser of w . v for some w inside
/// `region`, sorted lexicographically. Duplicates are dropped.
/// @throws std::invalid_argument unless all vectors have three entries.
[[nodiscard]] std::vector<IntegerVector> upper_hull(std::span<const IntegerVector> vectors, const Cone& region);

}  // namespace kith
