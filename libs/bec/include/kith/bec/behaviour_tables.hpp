#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/bec/constraint_set.hpp"
#include "kith/bec/knowledge_component.hpp"
#include "kith/bec/policy_cells.hpp"
#include "kith/core/index.hpp"
#include "kith/core/integer_vector.hpp"

namespace kith {

/// A (MDP, start) pair's position among all of a domain's, MDP by MDP.
using StartIndex = Index<struct StartTag>;

/// What people would do from every start, whatever their weights: the coverage sets, and the policy cell of every
/// weight, so that "what would this person expect the robot to do?" is a look-up. An Atlas has them where its domain is
/// exact and small and has three features.
///
/// Immutable after construction and safe to share between threads.
class BehaviourTables {
 public:
  [[nodiscard]] const PolicyCells& cells() const noexcept { return cells_; }
  [[nodiscard]] std::size_t num_hulls() const noexcept { return hulls_.size(); }
  [[nodiscard]] HullIndex hull(StartIndex start) const { return starts_[start.value()].hull; }
  [[nodiscard]] const Hull& hull(HullIndex h) const { return hulls_[h.value()]; }

  /// Vertices of the coverage set of every start state: in all and at most.
  struct Coverage {
    std::size_t vertices = 0;
    double mean = 0.0;
    std::size_t max = 0;
  };
  [[nodiscard]] const Coverage& coverage() const noexcept { return coverage_; }
  /// The feature counts of the coverage set of a start state, sorted.
  [[nodiscard]] std::vector<IntegerVector> coverage_set(StartIndex start) const;
  /// Feature counts of the path that a person of this cell takes, or nothing if they have no optimum there.
  [[nodiscard]] std::optional<IntegerVector> answer(StartIndex start, PolicyCellIndex cell) const;
  /// Whether weights have a finite optimum in the demonstration's MDP (strictly inside its region).
  [[nodiscard]] const Cone& finite_region(StartIndex start) const { return hull(hull(start)).finite_region; }
  /// Constraints that tell the robot's path from the next best ones at the start: the facets of its cell in the
  /// coverage set.
  [[nodiscard]] const ConstraintSet& robot_cell_facets(StartIndex start) const { return facets_[hull(start).value()]; }

  /// What demonstrations convey to people who hold weights of the given cells: per class, one row of words, the union
  /// over cells and over the states s_t of the path of mu_robot(s_t) - mu_learner(s_t). Cells without an optimum in the
  /// MDP contribute nothing. Shape [Atlas::num_start_classes(), Atlas::words_per_set()].
  [[nodiscard]] std::vector<std::uint64_t> conveyed_by_class(std::span<const PolicyCellIndex> cells) const;
  /// The same for the demonstrations of one class, not reduced.
  [[nodiscard]] ConstraintSet conveyed(StartClassIndex start_class, std::span<const PolicyCellIndex> cells) const;

 private:
  friend class AtlasBuilder;

  struct Start {
    IntegerVector robot_counts;
    HullIndex hull;
  };

  // Adds what demonstrations of a class convey to anybody.
  void add_conveyed(StartClassIndex start_class, ConstraintSet& set) const;
  // ORs into `row` what hull h conveys to the cells.
  void add_conveyed(HullIndex h, std::span<const PolicyCellIndex> cells, std::span<std::uint64_t> row) const;

  std::size_t num_constraints_ = 0;
  std::vector<Start> starts_;  // per demonstration
  std::vector<Hull> hulls_;
  std::vector<ConstraintSet> facets_;                   // per hull
  std::vector<std::vector<std::int32_t>> constraints_;  // per hull and vertex: constraint number, or -1 for no loss
  std::vector<std::vector<HullIndex>> hulls_of_class_;  // of all states on the path, those with anything to convey
  PolicyCells cells_;
  Coverage coverage_;
};

}  // namespace kith
