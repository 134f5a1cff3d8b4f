#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/domains/policy_file.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {

/// A state in which a robot does something else than what is best under some weights.
struct UnexplainedState {
  StartId state;
  std::optional<ActionIndex> does;  ///< What it does most often; nothing if that is no action of the MDP.
  ActionIndex best;                 ///< What would be best.
  double loss = 0.0;                ///< What the former gives away, with weights at length 1; 0 without it.
};

/// What the robot does in a few states that no weights explain together: each of them prefers something, and the
/// preferences contradict each other. A further feature would have to tell these states apart.
struct Clash {
  std::vector<StartId> states;  ///< The first is unexplained. Those of half-spaces that everybody knows are left out.
  std::vector<HalfSpace> half_spaces;  ///< What the robot would have to prefer; that of the first state first.
};

/// A facet of the region of weights, and how many states show it. A facet that only few states show rests on these.
struct RegionSide {
  HalfSpace half_space;
  std::size_t support = 0;  ///< 0: no state, but everybody knows it.
};

/// The reward weights that explain what a robot does.
struct WeightInference {
  /// Weights, shape [d], of about length 1 and with few digits, strictly inside the region. If the robot takes several
  /// choices that are equally good under some weights of its boundary only: these, as integers.
  std::vector<double> weights;
  /// All weights, within the prior, under which what `weights` explain of what was seen is best. Where the robot's way
  /// leads on through states in which it was not seen, a region that holds all of these; where `weights` do not explain
  /// what it does, it is taken to do what is best under them.
  Cone region;
  double margin = 0.0;       ///< Sine of the angle from the weights to the nearest facet; 1 without facets, 0 of a tie.
  bool is_optimal = false;   ///< Whether the policy is optimal under the weights wherever it was seen.
  double share = 0.0;        ///< Of what the robot does, what is best under the weights: mean over states seen.
  double loss = 0.0;         ///< What its actions give away, mean over states seen, weights at length 1; >= 0.
  std::size_t num_seen = 0;  ///< States.
  std::vector<UnexplainedState> unexplained;  ///< Where what it does most often is not best; by MDP and state.
  std::vector<Clash> clashes;                 ///< Of the unexplained states that lose most, at most three.
  std::vector<RegionSide> sides;              ///< Of the region; those that rest on the fewest states first.
  /// Starts from which the robot, or what is best, most likely meets a state that is not explained, or may meet one in
  /// which it was not seen; ascending. Where chance has a part, other paths than the likeliest one may still meet a
  /// state that is not explained.
  std::vector<StartId> left_out;
  std::vector<StartId> not_explained;  ///< The states that are not explained or not seen, ascending.
};

/// What a domain file says of weights that were found (with_inferred_weights()).
[[nodiscard]] InferredWeights as_inferred(const WeightInference& inference);

/// Reward weights for a policy of which nobody wrote any down; those of the domain do not matter.
///
/// A policy that is known everywhere is optimal exactly under the weights of its behaviour equivalence class (Eq. 1 of
/// [jayaraman2024], with all one-step deviations from it), within the prior. If that has an interior, these are its
/// weights. If not, or if it is known in some states only, weights are sought that explain most: from many that cover
/// the prior, those that explain most states are improved by adding what states demand, from the one that is satisfied
/// best to the one that is satisfied least, as long as some weights are left, until no more states are explained. A
/// state is explained if what the robot does there is as good as any action under the weights (to 1e-9), given that
/// everything after it is best.
///
/// @throws std::invalid_argument unless the policy has the domain's shape.
/// @throws kith::Error (kInfeasible): E0341 if the best weights explain less than half of what the robot does, or no
/// more than they would of one that acts at random (which is sure to 95 %, by [hoeffding1963]); E0342 if
/// nothing follows from what was seen; E0343 if no start is left.
[[nodiscard]] WeightInference infer_weights(const Domain& domain, const ObservedPolicy& policy);

}  // namespace kith
