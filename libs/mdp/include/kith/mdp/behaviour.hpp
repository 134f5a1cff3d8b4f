#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/core/integer_vector.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith {

/// How behave() counts and compares.
struct BehaveOptions {
  /// Feature counts are kept in units of 1 / scale, rounded to nearest; at least 1.
  std::int64_t scale = 1;
  /// Choices worth at least V(s) - tolerance * max(1, |V(s)|) count as optimal.
  double tolerance = 1e-9;
};

/// What somebody with given reward weights does in any Mdp: one choice per
/// state, and what it earns.
struct Behaviour {
  /// Indices into mdp.choices(s) of the first optimal choice in action order, shape [num_states]. Where always taking
  /// the first would never end, the states that do not end take the first that leads to one that does.
  std::vector<std::uint32_t> choice;
  /// The optimal values V(s), shape [num_states + num_terminals]; 0 at terminal states.
  std::vector<double> values;
  /// Expected (discounted) feature counts of `choice` in units of 1 / scale, shape [num_states + num_terminals]. They
  /// are computed from `choice` alone: equal choices have equal counts, however they were found.
  std::vector<IntegerVector> counts;
};

/// Whether behave() plans this process exactly: it is deterministic, undiscounted and has integer features.
[[nodiscard]] bool is_exact(const Mdp& mdp) noexcept;

/// The optimal behaviour under real weights, for deterministic and stochastic,
/// undiscounted and discounted processes with any features.
///
/// An exact process (is_exact()) is answered as by plan_exactly(), to the integer:
/// nothing if a cycle gains or earns nothing within the tolerance, or if a state
/// cannot reach a terminal one. It is solved component by component, by Dijkstra's
/// algorithm where no transition within the component earns, by label correcting
/// where one does.
///
/// Any other undiscounted process is optimised over the policies that finish with probability 1
/// (policy iteration [bertsekas1991]); nothing if some states can be kept in forever at a gain per step, or cannot
/// finish at all. Where staying costs and earns nothing, finishing is required all the same. A discounted process
/// has an optimum unless some state has no choice.
/// @throws std::invalid_argument unless weights.size() == d, the weights are finite, tolerance >= 0 and scale >= 1;
/// kith::Error (kInfeasible) unless counts stay below 2^53 units: what ends too rarely cannot be counted.
[[nodiscard]] std::optional<Behaviour> behave(const Mdp& mdp, std::span<const double> weights,
                                              const BehaveOptions& options = {});

/// Benefit of the doubt: among the choices that are optimal for `weights`, those that earn most under the robot's
/// weights, by a second dynamic programme. `choice` and `counts` are theirs, `values` are under `weights`. Nothing if
/// behave() finds nothing, or if the remaining choices gain for ever under the robot's weights.
/// @throws as behave(), for both weights.
[[nodiscard]] std::optional<Behaviour> behave_in_favour(const Mdp& mdp, std::span<const double> weights,
                                                        std::span<const double> robot_weights,
                                                        const BehaveOptions& options = {});

/// What a policy counts: expected (discounted) feature counts from every state in units of 1 / scale, rounded to
/// nearest, shape [num_states + num_terminals]. Nothing if it is undiscounted and does not surely end from some state,
/// or ends so rarely that it cannot be counted.
/// @param choice  indices into mdp.choices(s), shape [num_states].
/// @throws std::invalid_argument unless the choices exist and scale >= 1.
[[nodiscard]] std::optional<std::vector<IntegerVector>> count_policy(const Mdp& mdp,
                                                                     std::span<const std::uint32_t> choice,
                                                                     std::int64_t scale = 1);

/// Whether choice `c` of state `s` is as good as any: E[w . phi + discount * V(s')] >= V(s) - tolerance * max(1,
/// |V(s)|) with the values V of a behaviour.
/// @pre behave(mdp, weights) or behave_in_favour(mdp, weights, ...) gave the behaviour.
/// @throws std::invalid_argument unless weights.size() == d, the weights are finite, tolerance >= 0, the behaviour has
/// as many values as the process and there is such a choice.
[[nodiscard]] bool is_optimal(const Mdp& mdp, const Behaviour& behaviour, std::span<const double> weights, StateIndex s,
                              std::size_t c, double tolerance = 1e-9);

}  // namespace kith
