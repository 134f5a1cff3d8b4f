#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "kith/mdp/planner.hpp"

namespace kith::testing {

/// The features that a path collects, shape [d]: sum over its steps t of discount^t phi(s_t, a_t, s_(t+1)). A cycle of
/// L actions that begins at step k counts as many times as it is gone round, discount^k c / (1 - discount^L) with c
/// what it collects once. Where chance has a part, what is collected if everything goes as the path says.
/// @throws std::invalid_argument if some action cannot lead along the path.
[[nodiscard]] inline std::vector<double> path_features(const Mdp& mdp, const Trajectory& path) {
  std::vector<double> sum(mdp.num_features(), 0.0);
  double share = 1.0;  // discount^t, of a cycle for all rounds
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    if (t == path.repeats_from) share /= 1.0 - std::pow(mdp.discount(), static_cast<double>(path.actions.size() - t));
    const auto choices = mdp.choices(path.states[t]);
    const auto choice = std::ranges::find(choices, path.actions[t], &Choice::action);
    if (choice == choices.end()) throw std::invalid_argument{"there is no such choice"};
    const auto outcomes = mdp.outcomes(*choice);
    const auto outcome = std::ranges::find(outcomes, path.states.at(t + 1), &Outcome::next);
    if (outcome == outcomes.end()) throw std::invalid_argument{"the action does not lead there"};
    const auto phi = mdp.features(*outcome);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += share * phi[k];
    share *= mdp.discount();
  }
  return sum;
}

}  // namespace kith::testing
