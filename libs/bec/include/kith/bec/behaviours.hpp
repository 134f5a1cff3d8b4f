#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "kith/bec/atlas.hpp"

namespace kith {

/// What people who hold given reward weights do, and what demonstrations tell
/// them: a look-up where the Atlas has tables, planned and remembered where not.
///
/// Without tables every weight that is met is a policy cell of its own, numbered in
/// order. For a cell and an MDP the behaviour is planned when it is first asked for (behave_in_favour(): the benefit of
/// the doubt), and of it only the losses on candidates' paths are kept, four bytes each. When more than
/// `max_cells` cells are kept the oldest are forgotten and, if asked for again, planned again: memory stays below
/// max_cells * 4 bytes * states on candidates' paths, plus the distinct losses.
///
/// With tables, one row of what is conveyed is kept per policy cell and demonstration class; when they take more than
/// `max_row_bytes` the oldest are forgotten and, if asked for again, computed again.
///
/// A cache in front of pure functions: results never depend on what was asked
/// before. Not thread-safe; give each thread its own. The atlas must outlive it.
class Behaviours {
 public:
  static constexpr std::size_t kDefaultCells = 256;
  static constexpr std::size_t kDefaultRowBytes = std::size_t{32} << 20u;

  explicit Behaviours(const Atlas& atlas, std::size_t max_cells = kDefaultCells,
                      std::size_t max_row_bytes = kDefaultRowBytes);
  Behaviours(const Behaviours&) = delete;
  Behaviours& operator=(const Behaviours&) = delete;
  ~Behaviours() = default;

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  /// The atlas's constraints and, after them, those met on the way. It grows; references to it stay valid.
  [[nodiscard]] const ConstraintTable& constraints() const noexcept { return constraints_; }

  /// The half-spaces as a set of constraints(); those met for the first time are added.
  [[nodiscard]] ConstraintSet numbers_of(std::span<const HalfSpace> half_spaces);
  /// About how much is remembered, in bytes.
  [[nodiscard]] std::size_t memory() const noexcept;

  /// Weights met so far, where behaviours are not tabulated.
  [[nodiscard]] std::size_t num_cells() const noexcept { return cells_.size(); }
  /// The cell of the weights, shape [d].
  PolicyCellIndex locate(const Direction& weights);

  /// Feature counts of what people of this cell do from a candidate start or a state on the robot's path from one, or
  /// nothing if they have no optimum there.
  std::optional<IntegerVector> answer(DemoIndex demo, PolicyCellIndex cell);

  /// The weights of a cell that locate() gave, where behaviours are not tabulated.
  [[nodiscard]] const Direction& weights(PolicyCellIndex cell) const { return cells_[cell.value()].weights; }
  /// The path that people with these weights take from there, or the likeliest one; nothing if they have no optimum.
  /// The path may break off where it never ends. Planned anew at every call.
  [[nodiscard]] std::optional<Trajectory> trajectory(DemoIndex demo, const Direction& weights) const;

  /// What demonstrations convey, by demonstration class.
  struct Conveyed {
    std::size_t words = 0;                       ///< Per row.
    std::span<const std::uint64_t> rows;         ///< Shape [num_demo_classes, words]; bit i stands for numbering[i].
    std::span<const ConstraintIndex> numbering;  ///< Empty: bit i stands for constraint i.

    /// The constraints of a row.
    [[nodiscard]] ConstraintSet set(DemoClassIndex c) const;
  };
  /// What the component's demonstrations convey to people of the given cells: the union over cells and over the states
  /// s_t of the path of mu_robot(s_t) - mu_learner(s_t). Cells without an optimum contribute nothing; rows of other
  /// components' classes may be empty. The result stays valid until the next call.
  Conveyed conveyed_by_class(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells);
  /// The same for one candidate, not reduced.
  ConstraintSet conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells);

 private:
  using LossIndex = std::int32_t;
  static constexpr LossIndex kNoOptimum = -1;
  struct Loss {
    IntegerVector counts;
    std::int32_t constraint = -1;  // -1: it tells nothing
  };
  struct Plan {
    bool is_known = false;
    bool has_optimum = false;
    std::vector<LossIndex> losses;  // per state on candidates' paths
  };
  struct Cell {
    Direction weights;
    std::vector<Plan> plans;  // per MDP; empty where forgotten
  };
  struct DirectionHash {
    std::size_t operator()(const Direction& weights) const noexcept;
  };

  Conveyed tabulated(std::span<const PolicyCellIndex> cells);
  Conveyed planned(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells);
  const Plan& plan_of(PolicyCellIndex cell, MdpIndex m);
  const std::vector<std::uint64_t>& rows_of(PolicyCellIndex cell);
  void remember(PolicyCellIndex cell);
  void plan(const Direction& weights, MdpIndex m, Plan& result);
  LossIndex number_of(const IntegerVector& loss);
  [[nodiscard]] LossIndex loss_at(const Plan& plan, DemoIndex demo) const;
  void add_conveyed(DemoIndex demo, std::span<const PolicyCellIndex> cells, std::vector<ConstraintIndex>& constraints);

  const Atlas* atlas_;
  std::size_t max_cells_;
  ConstraintTable constraints_;

  // Tabulated: rows per cell, and their union.
  std::vector<std::vector<std::uint64_t>> rows_by_cell_;  // empty where not asked for yet, or forgotten
  std::vector<PolicyCellIndex> cells_with_rows_;          // a ring of max_cells_with_rows_
  std::size_t max_cells_with_rows_ = 1;
  std::size_t oldest_rows_ = 0;
  std::vector<std::uint64_t> rows_;

  // On demand.
  std::unordered_map<Direction, PolicyCellIndex, DirectionHash> index_;
  std::vector<Cell> cells_;
  std::vector<PolicyCellIndex> remembered_;  // a ring of max_cells_
  std::size_t oldest_ = 0;
  std::vector<Loss> losses_;
  std::unordered_map<IntegerVector, LossIndex> loss_index_;
  std::vector<std::vector<StateIndex>> states_on_paths_;  // per MDP, ascending
  std::vector<std::int32_t> place_on_paths_;              // per demonstration: position in its MDP's list; -1: none
  std::vector<double> robot_weights_;
  std::vector<ConstraintIndex> numbering_;
  std::vector<std::uint32_t> bit_of_;  // per constraint
};

}  // namespace kith
