#include "kith/mdp/planner.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "checks.hpp"
#include "kith/core/assert.hpp"
#include "longest_path.hpp"

namespace kith {
namespace {

using detail::require;
using detail::require_exact;

bool is_tight(double value, double candidate, double tolerance) {
  return candidate >= value - tolerance * std::max(1.0, std::abs(value));
}

// Fills in the canonical choices and their feature counts, states in tight order.
template <typename Solution, typename IsTight>
void follow_first_tight(const Mdp& mdp, std::span<const StateIndex> order, const IsTight& tight, Solution& solution) {
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
  detail::LongestPaths<std::int64_t> paths{mdp, detail::row_rewards(mdp, weights, "plan_exactly")};
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

std::optional<RealSolution> plan(const Mdp& mdp, std::span<const double> weights, double tolerance) {
  require_exact(mdp, weights.size(), "plan");
  detail::require_weights(mdp, weights, "plan");
  require(tolerance >= 0.0, "plan", "the tolerance must not be negative");
  if (stranded_state(mdp)) return std::nullopt;
  detail::LongestPaths<double> paths{mdp, detail::row_rewards(mdp, weights)};
  if (!paths.solve_to_terminals()) return std::nullopt;
  const auto& values = paths.values();
  const auto tight = [&](std::size_t from, std::size_t next, std::size_t row) {
    return is_tight(values[from], paths.reward(row) + values[next], tolerance);
  };
  const auto order = detail::order_tight_edges(mdp, tight);
  if (!order.cycle.empty()) return std::nullopt;
  RealSolution solution;
  follow_first_tight(mdp, order.states, tight, solution);
  solution.values = std::move(paths.values());
  return solution;
}

bool is_optimal_choice(const Mdp& mdp, const RealSolution& solution, std::span<const double> weights, StateIndex s,
                       std::size_t c, double tolerance) {
  require_exact(mdp, weights.size(), "is_optimal_choice");
  require(s.value() < mdp.num_states() && c < mdp.choices(s).size(), "is_optimal_choice", "there is no such choice");
  const Outcome& outcome = mdp.outcomes(mdp.choices(s)[c]).front();
  const double reward = dot(mdp.integer_features(outcome), weights);
  return is_tight(solution.values[s.value()], reward + solution.values[outcome.next.value()], tolerance);
}

std::vector<IntegerVector> best_for_robot(const Mdp& mdp, const RealSolution& learner,
                                          std::span<const double> learner_weights, const IntegerVector& robot_weights,
                                          double tolerance) {
  require_exact(mdp, learner_weights.size(), "best_for_robot");
  require(robot_weights.size() == mdp.num_features(), "best_for_robot", "there must be one robot weight per feature");
  const auto rewards = detail::row_rewards(mdp, learner_weights);
  const auto tight = [&](std::size_t from, std::size_t next, std::size_t row) {
    return is_tight(learner.values[from], rewards[row] + learner.values[next], tolerance);
  };
  const auto order = detail::order_tight_edges(mdp, tight);
  require(order.cycle.empty(), "best_for_robot", "the tolerance is wider than that of the learner's solution");

  std::vector<IntegerVector> counts(mdp.num_states() + mdp.num_terminals(), IntegerVector(mdp.num_features()));
  for (const StateIndex s : order.states) {
    std::optional<Int128> best;
    for (const Choice& choice : mdp.choices(s)) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      if (!tight(s.value(), outcome.next.value(), outcome.feature_row)) continue;
      const IntegerVector mu = mdp.integer_features(outcome) + counts[outcome.next.value()];
      const Int128 earned = dot(robot_weights, mu);
      if (best && earned <= *best) continue;
      best = earned;
      counts[s.value()] = mu;
    }
  }
  return counts;
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

}  // namespace kith
