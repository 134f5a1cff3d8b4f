#include "kith/mdp/planner.hpp"

#include <algorithm>
#include <utility>

#include "checks.hpp"
#include "kith/core/assert.hpp"
#include "longest_path.hpp"

namespace kith {
namespace {

using detail::require;
using detail::require_exact;

// Fills in the canonical choices and their feature counts, states in tight order.
template <typename IsTight>
void follow_first_tight(const Mdp& mdp, std::span<const StateIndex> order, const IsTight& tight,
                        ExactSolution& solution) {
  solution.canonical_choice.assign(mdp.num_states(), 0);
  solution.feature_counts.assign(mdp.num_states() + mdp.num_terminals(), IntegerVector(mdp.num_features()));
  for (const StateIndex s : order) {
    const auto choices = mdp.choices(s);
    const auto first = std::ranges::find_if(choices, [&](const Choice& choice) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      return tight(s.value(), outcome.next.value(), outcome.feature_row);
    });
    KITH_ASSERT(first != choices.end());
    const Outcome& outcome = mdp.outcomes(*first).front();
    solution.canonical_choice[s.value()] = static_cast<std::uint32_t>(first - choices.begin());
    solution.feature_counts[s.value()] = mdp.integer_features(outcome) + solution.feature_counts[outcome.next.value()];
  }
}

// Some state from which no terminal state can be reached.
std::optional<StateIndex> stranded_state(const Mdp& mdp) {
  if (mdp.by_distance().size() == mdp.num_states()) return std::nullopt;
  std::vector<bool> safe(mdp.num_states(), false);
  for (const StateIndex s : mdp.by_distance()) safe[s.value()] = true;
  return StateIndex{static_cast<std::size_t>(std::ranges::find(safe, false) - safe.begin())};
}

}  // namespace

ExactPlan plan_exactly(const Mdp& mdp, const IntegerVector& weights) {
  require_exact(mdp, weights.size(), "plan_exactly");
  ExactPlan plan;
  detail::LongestPaths paths{mdp, detail::row_rewards(mdp, weights, "plan_exactly")};
  if (const auto stranded = stranded_state(mdp)) {
    plan.failure = PlanFailure::kNoTerminal;
    plan.cycle = {*stranded};
    return plan;
  }

  if (!paths.solve_to_terminals()) {
    plan.failure = PlanFailure::kPositiveCycle;
    plan.cycle = paths.cycle();
    return plan;
  }

  const auto& values = paths.values();
  const auto tight = [&](std::size_t from, std::size_t next, std::size_t row) {
    return values[from] == paths.reward(row) + values[next];
  };
  auto order = detail::order_tight_edges(mdp, tight);
  if (!order.cycle.empty()) {
    plan.failure = PlanFailure::kZeroCycle;
    plan.cycle = std::move(order.cycle);
    return plan;
  }

  follow_first_tight(mdp, order.states, tight, plan.solution.emplace());
  plan.solution->values = std::move(paths.values());
  return plan;
}

Trajectory canonical_trajectory(const Mdp& mdp, std::span<const std::uint32_t> canonical_choice, StateIndex start) {
  constexpr const char* kName = "canonical_trajectory";
  require(mdp.is_deterministic(), kName, "the process must be deterministic");
  require(canonical_choice.size() == mdp.num_states(), kName, "there must be one choice per state");
  require(start.value() < mdp.num_states() + mdp.num_terminals(), kName, "the start state is out of range");
  Trajectory path;
  path.states.push_back(start);
  while (!mdp.is_terminal(path.states.back())) {
    require(path.actions.size() < mdp.num_states(), kName, "the choices never reach a terminal state");
    const StateIndex s = path.states.back();
    const auto choices = mdp.choices(s);
    require(canonical_choice[s.value()] < choices.size(), kName, "there is no such choice");
    const Choice& choice = choices[canonical_choice[s.value()]];
    path.actions.push_back(choice.action);
    path.states.push_back(mdp.outcomes(choice).front().next);
  }
  return path;
}

Trajectory written_out(Trajectory path, std::size_t steps) {
  while (path.repeats_from && path.actions.size() < steps) {
    path.actions.push_back(path.actions[*path.repeats_from]);
    path.states.push_back(path.states[++*path.repeats_from]);
  }
  return path;
}

std::optional<std::size_t> first_difference(const Trajectory& a, const Trajectory& b) {
  const auto has = [](const Trajectory& path, std::size_t t) { return path.repeats_from || t < path.actions.size(); };
  // Two cycles that agree for as many steps as both have together agree for ever.
  for (std::size_t t = 0; t < a.actions.size() + b.actions.size(); ++t) {
    if (!has(a, t) && !has(b, t)) return std::nullopt;
    if (!has(a, t) || !has(b, t) || a.action(t) != b.action(t)) return t;
  }
  return std::nullopt;
}

}  // namespace kith
