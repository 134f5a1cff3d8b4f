#include "kith/mdp/behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "checks.hpp"
#include "component_paths.hpp"
#include "kith/core/error.hpp"
#include "path_follower.hpp"
#include "policy_evaluation.hpp"
#include "policy_solver.hpp"

namespace kith {
namespace {

using detail::ChoiceMask;
using detail::ComponentPaths;
using detail::is_tight;
using detail::PathFollower;
using detail::PathsFound;
using detail::PolicySolver;
using detail::require;
using detail::RobotWeights;

bool can_go_on_everywhere(const Mdp& mdp) {
  if (mdp.discount() == 1.0) return mdp.by_distance().size() == mdp.num_states();
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    if (mdp.choices(StateIndex{s}).empty()) return false;
  }
  return true;
}

void count_in_units(std::int64_t scale, std::vector<IntegerVector>& counts) {
  if (scale == 1) return;
  for (IntegerVector& mu : counts)
    for (std::size_t k = 0; k < mu.size(); ++k) mu[k] *= scale;
}

std::vector<IntegerVector> rounded(const Mdp& mdp, std::span<const double> features, std::int64_t scale) {
  const std::size_t d = mdp.num_features();
  std::vector<IntegerVector> counts;
  counts.reserve(features.size() / d);
  for (std::size_t i = 0; i < features.size(); i += d)
    counts.push_back(detail::in_units(features.subspan(i, d), scale));
  return counts;
}

std::optional<std::vector<double>> optimal_values(const Mdp& mdp, std::span<const double> rewards, double tolerance,
                                                  const PolicySolver& solver) {
  if (mdp.is_deterministic() && mdp.discount() == 1.0) {
    ComponentPaths paths{mdp, rewards, tolerance};
    // What looks like a gain here may be the rounding of a cycle that earns nothing.
    if (paths.solve() != PathsFound::kPositiveCycle) return std::move(paths.values());
  }
  return solver.optimal_values();
}

// Whether no single choice of the mask is better for the robot than what the policy with these features does: then the
// policy is best for it among the choices of the mask.
bool suits_the_robot(const Mdp& mdp, std::span<const double> robot, double tolerance, const ChoiceMask& mask,
                     const detail::Policy& policy, std::span<const double> features) {
  const auto rewards = detail::row_rewards(mdp, robot);
  const double slack = std::max(1e-13, 0.01 * tolerance);  // as in policy iteration
  const auto value = [&](StateIndex s) {
    double sum = 0.0;
    for (std::size_t k = 0; k < robot.size(); ++k) sum += robot[k] * features[s.value() * robot.size() + k];
    return sum;
  };
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    const auto choices = mdp.choices(s);
    const std::size_t first = mdp.first_choice(s);
    for (std::size_t c = 0; c < choices.size(); ++c) {
      if (mask[first + c] == 0 || c == policy.choice[s.value()]) continue;
      double worth = 0.0;
      for (const Outcome& outcome : mdp.outcomes(choices[c])) {
        worth += outcome.probability * (rewards[outcome.feature_row] + mdp.discount() * value(outcome.next));
      }
      const double own = value(s);
      if (worth > own + slack * std::max(1.0, std::abs(own))) return false;
    }
  }
  return true;
}

std::optional<Behaviour> behave_generally(const Mdp& mdp, std::span<const double> rewards, const RobotWeights& robot,
                                          const BehaveOptions& options) {
  const ChoiceMask all;
  const PolicySolver solver{mdp, rewards, options.tolerance, all};
  auto values = optimal_values(mdp, rewards, options.tolerance, solver);
  if (!values) return std::nullopt;
  ChoiceMask choices = solver.tight_choices(*values);
  if (robot && mdp.discount() < 1.0) {
    // Mostly what is best is so for the robot, too, or differs in nothing that counts.
    detail::Policy policy = detail::first_finishing(mdp, choices);
    const auto features = detail::policy_features(mdp, policy);
    if (detail::takes_first(mdp, choices, policy) &&
        suits_the_robot(mdp, *robot, options.tolerance, choices, policy, features)) {
      return Behaviour{std::move(policy.choice), std::move(*values), rounded(mdp, features, options.scale)};
    }
  }
  if (robot) {
    const auto robot_rewards = detail::row_rewards(mdp, *robot);
    const PolicySolver robot_solver{mdp, robot_rewards, options.tolerance, choices};
    const auto robot_values = robot_solver.optimal_values();
    if (!robot_values) return std::nullopt;
    choices = robot_solver.tight_choices(*robot_values);
  }
  Behaviour behaviour;
  detail::Policy policy = detail::first_finishing(mdp, choices);
  behaviour.counts = rounded(mdp, detail::policy_features(mdp, policy), options.scale);
  behaviour.choice = std::move(policy.choice);
  behaviour.values = std::move(*values);
  return behaviour;
}

std::optional<Behaviour> behave_as(const Mdp& mdp, std::span<const double> weights, const RobotWeights& robot,
                                   const BehaveOptions& options) {
  detail::require_weights(mdp, weights, "behave");
  if (robot) detail::require_weights(mdp, *robot, "behave");
  require(options.tolerance >= 0.0, "behave", "the tolerance must not be negative");
  require(options.scale >= 1, "behave", "the scale must be at least 1");
  if (!can_go_on_everywhere(mdp)) return std::nullopt;
  const auto rewards = detail::row_rewards(mdp, weights);
  if (!is_exact(mdp)) return behave_generally(mdp, rewards, robot, options);

  ComponentPaths paths{mdp, rewards, options.tolerance};
  if (paths.solve() != PathsFound::kAll) return std::nullopt;
  Behaviour behaviour;
  behaviour.choice.resize(mdp.num_states());
  behaviour.counts.assign(paths.values().size(), IntegerVector(mdp.num_features()));
  PathFollower follower{mdp, rewards, paths.values(), options.tolerance};
  // In the order in which states are stored: far fewer cache misses than along the paths.
  for (std::size_t s = 0; s < mdp.num_states(); ++s) follower.find_step(s);
  for (const std::uint32_t s : paths.order()) behaviour.choice[s] = follower.follow(s, robot, behaviour.counts).choice;
  count_in_units(options.scale, behaviour.counts);
  behaviour.values = std::move(paths.values());
  return behaviour;
}

}  // namespace

bool is_exact(const Mdp& mdp) noexcept { return mdp.is_deterministic() && mdp.is_integral() && mdp.discount() == 1.0; }

std::optional<Behaviour> behave(const Mdp& mdp, std::span<const double> weights, const BehaveOptions& options) {
  return behave_as(mdp, weights, std::nullopt, options);
}

std::optional<Behaviour> behave_in_favour(const Mdp& mdp, std::span<const double> weights,
                                          std::span<const double> robot_weights, const BehaveOptions& options) {
  return behave_as(mdp, weights, robot_weights, options);
}

std::optional<std::vector<IntegerVector>> count_policy(const Mdp& mdp, std::span<const std::uint32_t> choice,
                                                       std::int64_t scale) {
  require(choice.size() == mdp.num_states(), "count_policy", "there must be a choice for every state");
  require(scale >= 1, "count_policy", "the scale must be at least 1");
  for (StateIndex s{0}; s.value() < choice.size(); ++s)
    require(choice[s.value()] < mdp.choices(s).size(), "count_policy", "there is no such choice");
  const auto policy = detail::make_policy(mdp, {choice.begin(), choice.end()});
  if (mdp.discount() == 1.0 && !policy.finishes()) return std::nullopt;
  const auto features = detail::policy_features(mdp, policy);
  const double most = 0x1p52 / static_cast<double>(scale);
  if (!std::all_of(features.begin(), features.end(), [&](double x) { return std::abs(x) < most; })) return std::nullopt;
  return rounded(mdp, features, scale);
}

bool is_optimal(const Mdp& mdp, const Behaviour& behaviour, std::span<const double> weights, StateIndex s,
                std::size_t c, double tolerance) {
  constexpr const char* kName = "is_optimal";
  detail::require_weights(mdp, weights, kName);
  require(tolerance >= 0.0, kName, "the tolerance must not be negative");
  require(behaviour.values.size() == mdp.num_states() + mdp.num_terminals(), kName, "there must be a value per state");
  require(s.value() < mdp.num_states() && c < mdp.choices(s).size(), kName, "there is no such choice");
  double worth = 0.0;
  for (const Outcome& outcome : mdp.outcomes(mdp.choices(s)[c])) {
    const auto phi = mdp.features(outcome);
    double reward = 0.0;
    for (std::size_t k = 0; k < phi.size(); ++k) reward += weights[k] * phi[k];
    worth += outcome.probability * (reward + mdp.discount() * behaviour.values[outcome.next.value()]);
  }
  return is_tight(behaviour.values[s.value()], worth, tolerance);
}

}  // namespace kith
