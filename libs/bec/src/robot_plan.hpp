#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kith/bec/constraint_table.hpp"
#include "kith/domains/domain.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

// What the robot does in one MDP: its choice in every state, what that counts, and where it most likely leads. Counts
// are in units of 1 / Domain::count_scale().
struct RobotPlan {
  std::vector<std::uint32_t> choice;           // indices into mdp.choices(s), shape [num_states]
  std::vector<IntegerVector> counts;           // shape [num_states + num_terminals]
  std::vector<std::uint32_t> next;             // state after s on the shown path, terminal or not; see likeliest_next()
  std::vector<std::uint32_t> optimal_choices;  // how many choices are optimal, shape [num_states]
};

// Nothing if the robot's weights have no finite optimum.
[[nodiscard]] std::optional<RobotPlan> plan_robot(const Domain& domain, MdpIndex m);

// Where a plan most likely leads from each state: along the likeliest way to an end; where there is none, the likeliest
// outcome that changes the state. Paths that never end come back to a state that they have met.
[[nodiscard]] std::vector<std::uint32_t> likeliest_next(const Mdp& mdp, const std::vector<std::uint32_t>& choice);

// The path from a state on, as likeliest_next() leads, until it ends or closes.
[[nodiscard]] Trajectory shown_path(const Mdp& mdp, std::span<const std::uint32_t> choice,
                                    std::span<const std::uint32_t> next, StateIndex start);

// Expected counts of a choice and of what follows it: `rest(state)`, whether terminal or not.
template <typename Rest>
[[nodiscard]] IntegerVector counts_of(const Mdp& mdp, const Choice& choice, std::int64_t scale, const Rest& rest) {
  const auto outcomes = mdp.outcomes(choice);
  if (scale == 1) return mdp.integer_features(outcomes.front()) + rest(outcomes.front().next);
  std::array<double, IntegerVector::kMaxDimension> sum{};
  for (const Outcome& outcome : outcomes) {
    const auto features = mdp.features(outcome);
    const IntegerVector& follows = rest(outcome.next);
    for (std::size_t k = 0; k < features.size(); ++k) {
      sum[k] += outcome.probability *
                (features[k] * static_cast<double>(scale) + mdp.discount() * static_cast<double>(follows[k]));
    }
  }
  IntegerVector result(mdp.num_features());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = std::llround(sum[k]);
  return result;
}

// All non-terminal states, each after the one that follows it on the shown path, but for the states of cycles: they
// come one after the other, in the order of the cycle.
struct PathOrder {
  std::vector<StateIndex> states;
  std::vector<std::uint32_t> cycle_length;  // per state of the Mdp, of the cycle that it lies on; 0: on none
};
[[nodiscard]] PathOrder successors_first(const Mdp& mdp, const RobotPlan& plan);

}  // namespace kith
