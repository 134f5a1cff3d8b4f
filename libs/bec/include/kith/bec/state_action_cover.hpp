#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/geometry/eigen.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith {

/// A set of state-action pairs that teaches a policy: whoever sees the robot's action in each of these states, and
/// knows the model, knows its behaviour equivalence class.
struct StateActionCover {
  Behaviour robot;                 ///< The policy that is taught; counts in units of 1 / kScale.
  std::vector<StateIndex> states;  ///< The states shown, in the order in which they were chosen.
  /// Unit normals of the class's half-spaces without redundant ones, shape [d, n].
  Eigen::MatrixXd facets;
  /// Unit normals of what the states shown convey: all comparisons there with other actions, shape [d, m].
  Eigen::MatrixXd conveyed;
  std::size_t num_comparisons = 0;  ///< Distinct half-spaces of the whole policy, redundant ones included.

  static constexpr std::int64_t kScale = std::int64_t{1} << 32;
};

/// Greedy set cover over state-action demonstrations [brown2019machine], in double precision: the half-spaces
/// { w : w . (mu(s, a) - mu(s, b)) >= 0 } of the robot's action a and every other action b in all `candidates`; those
/// that the others imply are left out; then the state that shows most of what is left is chosen, of several the
/// first, until all is shown. Half-spaces whose unit normals differ by less than 1e-6 in every entry are the same.
/// Unlike an Atlas it needs no integers, so that it does not round in many dimensions.
/// @param weights  the robot's, shape [d]; where several actions are optimal it takes the first.
/// @return Nothing if the robot has no finite optimum.
/// @throws std::invalid_argument as behave(), or if a candidate is terminal.
[[nodiscard]] std::optional<StateActionCover> cover_state_actions(const Mdp& mdp, std::span<const double> weights,
                                                                  std::span<const StateIndex> candidates);

/// The positions of the columns that the cone of the other columns left does not contain, ascending: the half-spaces
/// with these normals that are not redundant. Columns are taken away one by one, first to last.
/// @param normals  unit vectors, shape [d, n].
/// @param tolerance  how far from the cone of the others a redundant normal may be.
[[nodiscard]] std::vector<std::size_t> irredundant_normals(const Eigen::MatrixXd& normals, double tolerance = 1e-7);

}  // namespace kith
