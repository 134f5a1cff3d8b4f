#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::testing {

/// What value_iteration() found.
struct ValueIterationResult {
  std::vector<double> values;  ///< Shape [num_states + num_terminals].
  /// First choice within 1e-9 * max(1, |V|) of the best, shape [num_states]; 0 in a dead end.
  std::vector<std::uint32_t> greedy_choice;
  std::size_t sweeps = 0;  ///< Including the last one, which changed nothing.
  bool converged = false;  ///< False: no finite optimum was found.
};

/// Value iteration, the plain way to plan for any Mdp:
///   V(s) = max_a sum_s' p(s' | s, a) (w . phi(s, a, s') + discount V(s')),
/// in place, nearest to a terminal state first, until no value changes by more than 1e-12 * max(1, largest |V|). Starts
/// at 0; at -infinity when undiscounted and deterministic, so that values only rise and |S| sweeps settle whether the
/// optimum is finite. Dead ends keep -infinity, and nothing has converged then. @param weights  shape [d].
inline ValueIterationResult value_iteration(const Mdp& mdp, std::span<const double> weights) {
  constexpr double kTolerance = 1e-12, kTie = 1e-9, kInfinity = std::numeric_limits<double>::infinity();
  const bool is_shortest_path = mdp.is_deterministic() && mdp.discount() == 1.0;
  const std::size_t n = mdp.num_states();
  const std::size_t most = is_shortest_path ? n + 1 : 1000 * (n + 1);

  std::vector<StateIndex> order(mdp.by_distance().begin(), mdp.by_distance().end());
  std::vector<bool> is_listed(n, false);
  for (const StateIndex s : order) is_listed[s.value()] = true;
  for (std::size_t s = 0; s < n; ++s) {
    if (!is_listed[s]) order.push_back(StateIndex{s});
  }

  ValueIterationResult result;
  result.values.assign(n + mdp.num_terminals(), 0.0);
  if (is_shortest_path) std::fill_n(result.values.begin(), n, -kInfinity);
  const auto worth = [&](const Choice& choice) {
    double sum = 0.0;
    for (const Outcome& outcome : mdp.outcomes(choice)) {
      const auto phi = mdp.features(outcome);
      double reward = 0.0;
      for (std::size_t k = 0; k < weights.size(); ++k) reward += weights[k] * phi[k];
      sum += outcome.probability * (reward + mdp.discount() * result.values[outcome.next.value()]);
    }
    return sum;
  };
  const auto best = [&](StateIndex s) {
    double most_worth = -kInfinity;
    for (const Choice& choice : mdp.choices(s)) most_worth = std::max(most_worth, worth(choice));
    return most_worth;
  };
  while (result.sweeps < most && !result.converged) {
    ++result.sweeps;
    double change = 0.0, largest = 0.0;
    for (const StateIndex s : order) {
      const double before = result.values[s.value()], after = best(s);
      if (before != after) change = std::max(change, std::abs(after - before));  // equal infinities are no change
      largest = std::max(largest, std::abs(after));
      result.values[s.value()] = after;
    }
    if (largest == kInfinity && !is_shortest_path) break;  // a dead end
    result.converged = change <= kTolerance * std::max(1.0, largest) && largest < kInfinity;
    if (change == 0.0) break;
  }
  for (std::size_t s = 0; s < n; ++s) {
    const double most_worth = best(StateIndex{s});
    const auto choices = mdp.choices(StateIndex{s});
    const auto first = std::find_if(choices.begin(), choices.end(), [&](const Choice& choice) {
      return worth(choice) >= most_worth - kTie * std::max(1.0, std::abs(most_worth));
    });
    result.greedy_choice.push_back(std::isfinite(most_worth) ? static_cast<std::uint32_t>(first - choices.begin())
                                                             : 0u);
  }
  return result;
}

}  // namespace kith::testing
