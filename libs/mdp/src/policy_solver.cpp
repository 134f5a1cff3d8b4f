#include "policy_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

#include "component_paths.hpp"
#include "kith/core/error.hpp"

namespace kith::detail {
namespace {

constexpr int kFewSweeps = 10;    // for a policy that is soon to be improved
constexpr int kFewPolicies = 50;  // after so many each is evaluated to the end: with a discount near 1 a few sweeps
                                  // come no nearer to its values, and what they improve is not the policy
constexpr int kMostPolicies = 10'000;  // in practice a few dozen

// Lists the states that finish under a policy of a deterministic process, by following its paths. Whether no other
// state has an allowed choice that leads to one of them.
bool finishes_as_far_as_allowed(const Mdp& mdp, const ChoiceMask& mask, Policy& policy) {
  enum class Mark : unsigned char { kNew, kOnWalk, kEnds };
  const std::size_t n = mdp.num_states();
  const auto next = [&](std::size_t s, std::size_t c) {
    return mdp.outcomes(mdp.choices(StateIndex{s})[c]).front().next.value();
  };
  std::vector<Mark> marks(n + mdp.num_terminals(), Mark::kNew);
  std::fill_n(marks.begin() + static_cast<std::ptrdiff_t>(n), mdp.num_terminals(), Mark::kEnds);
  policy.finishing.reserve(n);
  std::vector<std::uint32_t> walk;
  for (std::size_t start = 0; start < n; ++start) {
    walk.clear();
    std::size_t s = start;
    for (; marks[s] == Mark::kNew; s = next(s, policy.choice[s])) {
      marks[s] = Mark::kOnWalk;
      walk.push_back(static_cast<std::uint32_t>(s));
    }
    if (marks[s] != Mark::kEnds) continue;  // it has met itself, or a path that never ends
    for (const std::uint32_t on : walk) marks[on] = Mark::kEnds;
    policy.finishing.insert(policy.finishing.end(), walk.rbegin(), walk.rend());
  }

  for (std::size_t s = 0; s < n && !policy.finishes(); ++s) {
    if (marks[s] == Mark::kEnds) continue;
    const std::size_t first = mdp.first_choice(StateIndex{s});
    for (std::size_t c = 0; c < mdp.choices(StateIndex{s}).size(); ++c) {
      if ((mask.empty() || mask[first + c] != 0) && marks[next(s, c)] == Mark::kEnds) return false;
    }
  }
  return true;
}

}  // namespace

Policy first_finishing(const Mdp& mdp, const ChoiceMask& mask) {
  const std::size_t n = mdp.num_states();
  const auto is_allowed = [&](StateIndex s, std::size_t c) {
    return mask.empty() || mask[mdp.first_choice(s) + c] != 0;
  };
  std::vector<std::uint32_t> first(n, 0);
  for (std::size_t s = 0; s < n; ++s)
    while (!is_allowed(StateIndex{s}, first[s])) ++first[s];
  if (mdp.is_deterministic() && mdp.discount() < 1.0) {
    Policy policy{std::move(first), {}};
    if (finishes_as_far_as_allowed(mdp, mask, policy)) return policy;
    first = std::move(policy.choice);
  }
  Policy policy = make_policy(mdp, std::move(first));
  if (policy.finishes()) return policy;

  // The states that finish are joined by those with a choice that may lead to one of them.
  std::vector<unsigned char> ends(n + mdp.num_terminals(), 1);
  std::fill_n(ends.begin(), n, static_cast<unsigned char>(0));
  for (const std::uint32_t s : policy.finishing) ends[s] = 1;
  const auto leads_to_end = [&](const Outcome& outcome) { return ends[outcome.next.value()] != 0; };
  const auto join_arrivals = [&](StateIndex next) {
    for (const Arrival& arrival : mdp.arrivals(next)) {
      const StateIndex from = arrival.from;
      if (ends[from.value()] != 0 || !is_allowed(from, arrival.choice)) continue;
      const auto choices = mdp.choices(from);
      std::uint32_t c = 0;
      while (!is_allowed(from, c) || !std::ranges::any_of(mdp.outcomes(choices[c]), leads_to_end)) ++c;
      policy.choice[from.value()] = c;
      ends[from.value()] = 1;
      policy.finishing.push_back(static_cast<std::uint32_t>(from.value()));
    }
  };
  for (std::size_t t = 0; t < mdp.num_terminals(); ++t) join_arrivals(StateIndex{n + t});
  for (std::size_t i = 0; i < policy.finishing.size(); ++i) join_arrivals(StateIndex{policy.finishing[i]});
  return make_policy(mdp, std::move(policy.choice));
}

Policy likeliest_finishing(const Mdp& mdp, const ChoiceMask& mask) {
  const std::size_t n = mdp.num_states();
  std::vector<double> chance(n + mdp.num_terminals(), 0.0);  // of the likeliest way to an end
  Policy policy = first_finishing(mdp, mask);
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached> reached;
  for (std::size_t t = n; t < chance.size(); ++t) reached.emplace(chance[t] = 1.0, t);
  while (!reached.empty()) {
    const auto [of_next, next] = reached.top();
    reached.pop();
    if (of_next < chance[next]) continue;
    for (const Arrival& arrival : mdp.arrivals(StateIndex{next})) {
      const std::size_t from = arrival.from.value();
      if (!mask.empty() && mask[mdp.first_choice(arrival.from) + arrival.choice] == 0) continue;
      double probability = 0.0;
      for (const Outcome& outcome : mdp.outcomes(mdp.choices(arrival.from)[arrival.choice]))
        probability += outcome.next.value() == next ? outcome.probability : 0.0;
      if (probability * of_next <= chance[from]) continue;
      chance[from] = probability * of_next;
      policy.choice[from] = arrival.choice;
      reached.emplace(chance[from], from);
    }
  }
  return make_policy(mdp, std::move(policy.choice));
}

bool takes_first(const Mdp& mdp, const ChoiceMask& mask, const Policy& policy) {
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    const auto first = mask.begin() + static_cast<std::ptrdiff_t>(mdp.first_choice(s));
    if (std::find(first, first + policy.choice[s.value()], 1) != first + policy.choice[s.value()]) return false;
  }
  return true;
}

PolicySolver::PolicySolver(const Mdp& mdp, std::span<const double> row_rewards, double tolerance,
                           const ChoiceMask& mask)
    : mdp_{mdp}, rewards_{row_rewards}, tolerance_{tolerance}, mask_{mask} {
  if (mdp.is_deterministic() && mdp.discount() < 1.0) steps_ = steps_of_choices(mdp);
}

double PolicySolver::worth(const Choice& choice, std::span<const double> values) const {
  double sum = 0.0;
  for (const Outcome& outcome : mdp_.outcomes(choice)) {
    sum += outcome.probability * (rewards_[outcome.feature_row] + mdp_.discount() * values[outcome.next.value()]);
  }
  return sum;
}

PolicyChain PolicySolver::chain_of(const Policy& policy) const {
  std::vector<double> immediate(mdp_.num_states(), 0.0);
  for (std::size_t s = 0; s < immediate.size(); ++s) {
    for (const Outcome& outcome : mdp_.outcomes(mdp_.choices(StateIndex{s})[policy.choice[s]])) {
      immediate[s] += outcome.probability * rewards_[outcome.feature_row];
    }
  }
  return PolicyChain{mdp_, policy, immediate, 1};
}

// Takes the best choice wherever it is clearly better than the one of the policy. Whether it was anywhere.
bool PolicySolver::improve(Policy& policy, std::span<const double> values) const {
  const double slack = std::max(1e-13, 0.01 * tolerance_);  // far within a tie, far above rounding
  bool improved = false;
  for (std::size_t s = 0; s < mdp_.num_states(); ++s) {
    const auto choices = mdp_.choices(StateIndex{s});
    const std::size_t first = mdp_.first_choice(StateIndex{s});
    const std::uint32_t current = policy.choice[s];
    double best = std::max(values[s], worth(choices[current], values)) + slack * std::max(1.0, std::abs(values[s]));
    for (std::uint32_t c = 0; c < choices.size(); ++c) {
      if (c == current || !is_allowed(first + c)) continue;
      const double candidate = worth(choices[c], values);
      if (candidate <= best) continue;
      best = candidate;
      policy.choice[s] = c;
      improved = true;
    }
  }
  if (improved) policy = make_policy(mdp_, std::move(policy.choice));
  return improved;
}

std::optional<std::vector<double>> PolicySolver::optimal_values() const {
  if (!steps_.next.empty()) {
    PathValues paths{mdp_, steps_, rewards_, tolerance_, mask_};
    paths.solve(states_by_distance(mdp_));
    return std::move(paths.values());
  }

  const bool must_finish = mdp_.discount() == 1.0;
  Policy policy = first_finishing(mdp_, mask_);
  if (must_finish && !policy.finishes()) return std::nullopt;
  std::vector<double> values(mdp_.num_states() + mdp_.num_terminals(), 0.0);
  const auto too_rare = [] {
    return Error{ErrorKind::kInfeasible,
                 "the robot or people would have to go on for longer than can be computed: everything that ends is too "
                 "unlikely; make ending likelier, or give a smaller discount"};
  };

  if (!chain_of(policy).solve(values)) {  // what comes first in the file may lead to an end by sheer chance
    policy = likeliest_finishing(mdp_, mask_);
    std::fill(values.begin(), values.end(), 0.0);
    if (!chain_of(policy).solve(values)) throw too_rare();
  }

  bool is_evaluated = true;
  for (int i = 0; i < kMostPolicies; ++i) {
    if (improve(policy, values)) {
      if (must_finish && !policy.finishes()) return std::nullopt;
      const auto chain = chain_of(policy);
      is_evaluated = i >= kFewPolicies || chain.sweep(kFewSweeps, values);
      if (i >= kFewPolicies && !chain.solve(values)) throw too_rare();
    } else if (is_evaluated) {
      return values;
    } else {
      if (!chain_of(policy).solve(values)) throw too_rare();
      is_evaluated = true;
    }
  }
  throw Error{ErrorKind::kInfeasible, "policy iteration does not converge"};
}

ChoiceMask PolicySolver::tight_choices(std::span<const double> values) const {
  ChoiceMask tight(mdp_.num_choices(), 0);
  if (!steps_.next.empty()) {
    for (std::size_t s = 0, c = 0; s < mdp_.num_states(); ++s) {
      for (const std::size_t last = c + mdp_.choices(StateIndex{s}).size(); c < last; ++c) {
        const double worth = rewards_[steps_.row[c]] + mdp_.discount() * values[steps_.next[c]];
        tight[c] = is_allowed(c) && is_tight(values[s], worth, tolerance_) ? 1 : 0;
      }
    }
    return tight;
  }
  for (std::size_t s = 0; s < mdp_.num_states(); ++s) {
    std::size_t c = mdp_.first_choice(StateIndex{s});
    for (const Choice& choice : mdp_.choices(StateIndex{s})) {
      tight[c] = is_allowed(c) && is_tight(values[s], worth(choice, values), tolerance_) ? 1 : 0;
      ++c;
    }
  }
  return tight;
}

}  // namespace kith::detail
