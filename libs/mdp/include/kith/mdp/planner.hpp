#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith {

/// A path through an Mdp: states[0] -actions[0]-> states[1] ... ; states has one entry more than actions.
///
/// A complete path either ends, in a terminal state, or never does: then it has a way in, which may be empty, and a
/// cycle. The last action leads back to a state that was met before, states.back() == states[*repeats_from], and the
/// actions from that one on are taken again and again.
struct Trajectory {
  std::vector<StateIndex> states;
  std::vector<ActionIndex> actions;
  std::optional<std::size_t> repeats_from{};  ///< Position in states, before the last; nothing where the path ends.

  /// The action at step t; on a path that never ends t may be any number. @pre t < actions.size() on others.
  [[nodiscard]] ActionIndex action(std::size_t t) const {
    return actions[t < actions.size() ? t : *repeats_from + (t - *repeats_from) % (actions.size() - *repeats_from)];
  }

  friend bool operator==(const Trajectory&, const Trajectory&) = default;
};

/// The same path with at least `steps` actions written out; for one that ends as many as it has.
[[nodiscard]] Trajectory written_out(Trajectory path, std::size_t steps);

/// The first step at which two paths take different actions, or at which only one has ended; nothing if they never do.
[[nodiscard]] std::optional<std::size_t> first_difference(const Trajectory& a, const Trajectory& b);

/// The optimal values and actions of a deterministic, undiscounted, integral
/// Mdp under integer reward weights; exact, ties included.
///
/// values[s] = max over paths from s to a terminal state of weights . mu(path).
struct ExactSolution {
  std::vector<std::int64_t> values;  ///< Shape [num_states + num_terminals]; 0 at terminals.
  /// Indices into mdp.choices(s) of the first optimal choice in canonical action order, shape [num_states].
  std::vector<std::uint32_t> canonical_choice;
  /// Feature counts mu of the canonical path from s, shape [num_states + num_terminals].
  std::vector<IntegerVector> feature_counts;
};

/// Why there is no optimal policy with a finite value.
enum class PlanFailure {
  kPositiveCycle,  ///< Some cycle earns a positive reward: the optimum is infinite.
  kZeroCycle,      ///< Some cycle earns exactly nothing: never finishing is as good as finishing.
  kNoTerminal,     ///< From some state no terminal state can be reached.
};

/// What plan_exactly() found: a solution, or why there is none and where.
struct ExactPlan {
  std::optional<ExactSolution> solution;
  std::optional<PlanFailure> failure;  ///< Set iff there is no solution.
  std::vector<StateIndex> cycle;       ///< For cycles: the states on it, in order. For kNoTerminal: one such state.
};

/// Bellman-Ford from the terminal states with exact detection of positive and
/// zero cycles. Among equally good actions the first in action order is
/// canonical. The canonical policy always terminates (ties are resolved among
/// optimal actions, whose graph has no cycle).
/// @throws std::invalid_argument unless the Mdp is deterministic, integral, has discount 1 and weights.size() == d,
/// or if weights are so large (about 2^60 / num_states per step) that values could overflow.
[[nodiscard]] ExactPlan plan_exactly(const Mdp& mdp, const IntegerVector& weights);

/// The canonical path of a solution from `start` to its terminal state.
/// @throws std::invalid_argument unless the Mdp is deterministic and the choices exist and lead to a terminal state.
[[nodiscard]] Trajectory canonical_trajectory(const Mdp& mdp, std::span<const std::uint32_t> canonical_choice,
                                              StateIndex start);

}  // namespace kith
