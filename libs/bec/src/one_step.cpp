#include "one_step.hpp"

namespace kith {

StateIndex next_state(const Mdp& mdp, const ExactSolution& robot, StateIndex s) {
  return mdp.outcomes(mdp.choices(s)[robot.canonical_choice[s.value()]]).front().next;
}

std::vector<ConstraintIndex> deviations(const Mdp& mdp, const ExactSolution& robot, StateIndex s,
                                        ConstraintTable& table) {
  std::vector<ConstraintIndex> result;
  const auto& here = robot.feature_counts[s.value()];
  for (const auto& choice : mdp.choices(s)) {
    const auto& outcome = mdp.outcomes(choice).front();
    const auto normal = here - mdp.integer_features(outcome) - robot.feature_counts[outcome.next.value()];
    if (!normal.is_zero()) result.push_back(table.add(HalfSpace{normal}));
  }
  return result;
}

std::size_t num_optimal_choices(const Mdp& mdp, const ExactSolution& robot, const IntegerVector& weights,
                                StateIndex s) {
  std::size_t n = 0;
  for (const auto& choice : mdp.choices(s)) {
    const auto& outcome = mdp.outcomes(choice).front();
    n += dot(weights, mdp.integer_features(outcome)) + robot.values[outcome.next.value()] == robot.values[s.value()]
             ? 1u
             : 0u;
  }
  return n;
}

std::vector<StateIndex> successors_first(const Mdp& mdp, const ExactSolution& robot) {
  std::vector<StateIndex> order;
  order.reserve(mdp.num_states());
  std::vector<bool> placed(mdp.num_states(), false);
  std::vector<StateIndex> path;
  for (StateIndex start{0}; start.value() < mdp.num_states(); ++start) {
    for (auto s = start; !mdp.is_terminal(s) && !placed[s.value()]; s = next_state(mdp, robot, s)) {
      placed[s.value()] = true;
      path.push_back(s);
    }
    order.insert(order.end(), path.rbegin(), path.rend());
    path.clear();
  }
  return order;
}

}  // namespace kith
