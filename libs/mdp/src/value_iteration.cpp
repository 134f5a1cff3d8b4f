#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "checks.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

using detail::require;

constexpr double kTieTolerance = 1e-9;  // relative; choices this close to the best count as equal
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_shortest_path_like(const Mdp& mdp) { return mdp.is_deterministic() && mdp.discount() == 1.0; }

std::size_t default_sweeps(const Mdp& mdp, double tolerance) {
  if (is_shortest_path_like(mdp)) return mdp.num_states() + 1;
  if (mdp.discount() == 1.0) return 1000 * (mdp.num_states() + 1);
  // discount^n <= tolerance * (1 - discount): what is left of the start is below the tolerance.
  const double n = std::log(std::min(tolerance, 1.0) * (1.0 - mdp.discount())) / std::log(mdp.discount());
  return static_cast<std::size_t>(std::min(std::ceil(n), 1e9)) + 2;
}

// Nearest to a terminal state first, then the states that cannot reach one.
std::vector<StateIndex> sweep_order(const Mdp& mdp) {
  std::vector<StateIndex> order(mdp.by_distance().begin(), mdp.by_distance().end());
  std::vector<bool> listed(mdp.num_states(), false);
  for (const StateIndex s : order) listed[s.value()] = true;
  for (std::size_t s = 0; s < listed.size(); ++s) {
    if (!listed[s]) order.push_back(StateIndex{s});
  }
  return order;
}

double expected_return(const Mdp& mdp, const Choice& choice, std::span<const double> row_rewards,
                       std::span<const double> values) {
  double sum = 0.0;
  for (const Outcome& outcome : mdp.outcomes(choice)) {
    sum += outcome.probability * (row_rewards[outcome.feature_row] + mdp.discount() * values[outcome.next.value()]);
  }
  return sum;
}

double best_return(const Mdp& mdp, StateIndex s, std::span<const double> row_rewards, std::span<const double> values) {
  double best = -kInfinity;
  for (const Choice& choice : mdp.choices(s)) {
    best = std::max(best, expected_return(mdp, choice, row_rewards, values));
  }
  return best;
}

std::uint32_t first_greedy(const Mdp& mdp, StateIndex s, std::span<const double> row_rewards,
                           std::span<const double> values) {
  const double best = best_return(mdp, s, row_rewards, values);
  if (!std::isfinite(best)) return 0;
  const auto choices = mdp.choices(s);
  const auto first = std::ranges::find_if(choices, [&](const Choice& choice) {
    return expected_return(mdp, choice, row_rewards, values) >= best - kTieTolerance * std::max(1.0, std::abs(best));
  });
  return static_cast<std::uint32_t>(first - choices.begin());
}

struct Sweep {
  double largest_change = 0.0;
  double largest_value = 0.0;
  // Equal values are no change, infinite ones included.
  void note(double before, double after) {
    if (before != after) largest_change = std::max(largest_change, std::abs(after - before));
    largest_value = std::max(largest_value, std::abs(after));
  }
  [[nodiscard]] bool is_still(double tolerance) const {
    return largest_change <= tolerance * std::max(1.0, largest_value);
  }
};

const Choice& choice_of(const Mdp& mdp, std::span<const std::uint32_t> choice, StateIndex s) {
  return mdp.choices(s)[choice[s.value()]];
}

// Whether a terminal state can be reached from every state under the policy.
bool is_proper(const Mdp& mdp, std::span<const std::uint32_t> choice) {
  std::vector<bool> seen(mdp.num_states(), false);
  std::vector<StateIndex> reached;
  const auto visit_arrivals = [&](StateIndex next) {
    for (const Arrival& arrival : mdp.arrivals(next)) {
      const std::size_t from = arrival.from.value();
      if (seen[from] || arrival.choice != choice[from]) continue;
      seen[from] = true;
      reached.push_back(arrival.from);
    }
  };
  for (std::size_t t = 0; t < mdp.num_terminals(); ++t) visit_arrivals(StateIndex{mdp.num_states() + t});
  for (std::size_t i = 0; i < reached.size(); ++i) visit_arrivals(reached[i]);
  return reached.size() == mdp.num_states();
}

}  // namespace

ValueIterationResult value_iteration(const Mdp& mdp, std::span<const double> weights,
                                     const ValueIterationOptions& options) {
  detail::require_weights(mdp, weights, "value_iteration");
  require(options.tolerance > 0.0, "value_iteration", "the tolerance must be positive");

  const auto row_rewards = detail::row_rewards(mdp, weights);
  const auto order = sweep_order(mdp);
  const std::size_t max_sweeps = options.max_sweeps > 0 ? options.max_sweeps : default_sweeps(mdp, options.tolerance);

  ValueIterationResult result;
  result.values.assign(mdp.num_states() + mdp.num_terminals(), 0.0);
  if (is_shortest_path_like(mdp)) std::fill_n(result.values.begin(), mdp.num_states(), -kInfinity);
  while (result.sweeps < max_sweeps && !result.converged) {
    ++result.sweeps;
    Sweep sweep;
    for (const StateIndex s : order) {
      const double value = best_return(mdp, s, row_rewards, result.values);
      sweep.note(result.values[s.value()], value);
      result.values[s.value()] = value;
    }
    if (sweep.largest_value == kInfinity && !is_shortest_path_like(mdp)) break;  // a dead end
    result.converged = sweep.is_still(options.tolerance) && sweep.largest_value < kInfinity;
    if (sweep.largest_change == 0.0) break;
  }
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    result.greedy_choice.push_back(first_greedy(mdp, StateIndex{s}, row_rewards, result.values));
  }
  return result;
}

std::vector<double> feature_expectations(const Mdp& mdp, std::span<const std::uint32_t> choice, double tolerance) {
  constexpr const char* kName = "feature_expectations";
  require(choice.size() == mdp.num_states(), kName, "there must be one choice per state");
  for (std::size_t s = 0; s < choice.size(); ++s) {
    require(choice[s] < mdp.choices(StateIndex{s}).size(), kName, "there is no such choice");
  }
  require(tolerance > 0.0, kName, "the tolerance must be positive");
  require(mdp.discount() < 1.0 || is_proper(mdp, choice), kName, "the policy must be able to finish from every state");

  const std::size_t d = mdp.num_features();
  const auto order = sweep_order(mdp);
  std::vector<double> mu((mdp.num_states() + mdp.num_terminals()) * d, 0.0);
  std::vector<double> sum(d);
  for (bool still = false; !still;) {
    Sweep sweep;
    for (const StateIndex s : order) {
      std::ranges::fill(sum, 0.0);
      for (const Outcome& outcome : mdp.outcomes(choice_of(mdp, choice, s))) {
        const auto phi = mdp.features(outcome);
        const double* next = &mu[outcome.next.value() * d];
        for (std::size_t k = 0; k < d; ++k) sum[k] += outcome.probability * (phi[k] + mdp.discount() * next[k]);
      }
      for (std::size_t k = 0; k < d; ++k) {
        sweep.note(mu[s.value() * d + k], sum[k]);
        mu[s.value() * d + k] = sum[k];
      }
    }
    still = sweep.is_still(tolerance);
  }
  return mu;
}

}  // namespace kith
