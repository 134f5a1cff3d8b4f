#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "kith/bec/constraint_table.hpp"
#include "kith/domains/domain.hpp"

namespace kith {

// What the robot does in one MDP: its choice in every state, what that counts, and where it most likely leads. Counts
// are in units of 1 / Domain::count_scale().
struct RobotPlan {
  static constexpr std::uint32_t kEnd = 0xFFFFFFFF;

  std::vector<std::uint32_t> choice;  // indices into mdp.choices(s), shape [num_states]
  std::vector<IntegerVector> counts;  // shape [num_states + num_terminals]
  std::vector<std::uint32_t> next;    // state after s on the shown path, terminal or not; kEnd where it breaks off
  std::vector<std::uint32_t> optimal_choices;  // how many choices are optimal, shape [num_states]
};

// Nothing if the robot's weights have no finite optimum.
[[nodiscard]] std::optional<RobotPlan> plan_robot(const Domain& domain, MdpIndex m);

// Where a plan most likely leads from each state, as in RobotPlan::next.
[[nodiscard]] std::vector<std::uint32_t> likeliest_next(const Mdp& mdp, const std::vector<std::uint32_t>& choice);

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

// All non-terminal states, each after the one that follows it on the shown path.
[[nodiscard]] std::vector<StateIndex> successors_first(const Mdp& mdp, const RobotPlan& plan);

}  // namespace kith
