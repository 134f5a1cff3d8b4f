#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/mdp/mdp.hpp"
#include "small_mdps.hpp"

// Small processes of every kind, and what they are worth: found by enumerating
// all deterministic policies and solving a dense linear system for each. Shares nothing
// with the library but the process itself.
namespace kith::testing {

enum class Kind { kDeterministic, kStochastic, kDiscounted };

struct Case {
  Mdp mdp;
  std::vector<double> weights;
  IntegerVector robot_weights;
};

namespace detail {

inline std::vector<double> random_features(std::size_t d, bool counts_steps, bool integral, RandomStream& random) {
  std::vector<double> phi(d);
  for (double& x : phi) x = static_cast<double>(uniform_integer(counts_steps ? 0 : -1, counts_steps ? 2 : 1, random));
  if (!integral) {
    for (double& x : phi) x *= 0.1 + uniform01(random);
  }
  if (counts_steps) phi.back() = 1.0;
  return phi;
}

// One to three ways on, with probabilities in quarters or of any size.
inline std::vector<MdpBuilder::Transition> random_transitions(const std::vector<std::size_t>& nexts, bool in_quarters,
                                                              RandomStream& random) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < nexts.size(); ++i) shares.push_back(in_quarters ? 1.0 : 0.05 + uniform01(random));
  if (in_quarters && nexts.size() == 2) shares = {3.0, 1.0};
  if (in_quarters && nexts.size() == 3) shares = {2.0, 1.0, 1.0};
  double sum = 0.0;
  for (const double share : shares) sum += share;
  std::vector<MdpBuilder::Transition> transitions;
  for (std::size_t i = 0; i < nexts.size(); ++i) transitions.push_back({StateIndex{nexts[i]}, shares[i] / sum, {}});
  return transitions;
}

}  // namespace detail

/// At most five states, three actions and `d` features. Dead ends, cycles that gain, cycles that earn nothing and
/// ties occur.
inline Case random_case(Kind kind, std::size_t d, RandomStream& random) {
  const std::size_t num_states = 1 + uniform_index(5, random);
  const std::size_t num_terminals = 1 + uniform_index(2, random);
  const bool counts_steps = uniform_index(4, random) != 0;
  const bool integral = uniform_index(3, random) != 0;
  const bool in_quarters = uniform_index(2, random) == 0;
  constexpr double kDiscounts[] = {0.5, 0.9, 0.99};
  const double discount = kind == Kind::kDiscounted ? kDiscounts[uniform_index(3, random)] : 1.0;
  const bool branches = kind == Kind::kStochastic || (kind == Kind::kDiscounted && uniform_index(2, random) == 0);
  MdpBuilder builder{num_states, num_terminals, 3, d, discount};
  for (std::size_t s = 0; s < num_states; ++s) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (uniform01(random) < 0.12) continue;
      std::vector<std::size_t> nexts{uniform_index(num_states + num_terminals, random)};
      while (branches && nexts.size() < 3 && uniform_index(3, random) != 0) {
        nexts.push_back(uniform_index(num_states + num_terminals, random));
      }
      if (std::ranges::all_of(nexts, [&](std::size_t next) { return next == s; })) continue;
      auto transitions = detail::random_transitions(nexts, in_quarters, random);
      for (auto& transition : transitions) {
        transition.features = detail::random_features(d, counts_steps, integral, random);
      }
      builder.add_choice(StateIndex{s}, ActionIndex{a}, transitions);
    }
  }
  Case result{std::move(builder).build(), {}, IntegerVector(d)};
  const bool real_weights = uniform_index(2, random) == 0;
  for (std::size_t k = 0; k < d; ++k) {
    const auto w = uniform_integer(k + 1 == d ? -6 : -3, k + 1 == d ? 1 : 2, random);
    result.weights.push_back(real_weights ? static_cast<double>(w) + uniform01(random) - 0.5 : static_cast<double>(w));
    result.robot_weights[k] = uniform_integer(-3, k + 1 == d ? -1 : 1, random);
  }
  return result;
}

/// What enumeration says about a process under one reward, among some choices.
class PolicyOracle {
 public:
  using Policy = std::vector<std::uint32_t>;

  PolicyOracle(const Mdp& mdp, std::span<const double> weights) : mdp_{mdp}, weights_{weights} {}

  /// Policies may use these choices only: allowed[s][c].
  void restrict(std::vector<std::vector<bool>> allowed) { allowed_ = std::move(allowed); }

  void enumerate() {
    for (std::size_t s = 0; s < mdp_.num_states(); ++s) has_dead_end = has_dead_end || choices(s).empty();
    if (has_dead_end) return;
    for_each_policy(mdp_, [&](const Policy& policy) {
      if (is_allowed(policy)) look_at(policy);
    });
    is_stranded = std::ranges::any_of(best, [](double x) { return std::isinf(x); }) || best.empty();
  }

  bool has_dead_end = false;  ///< Some state has no choice.
  bool is_stranded = false;   ///< From some state no policy finishes for certain (undiscounted).
  /// The highest gain per step of any policy in a set of states that it never leaves (undiscounted); -infinity if
  /// every policy finishes.
  double highest_gain = -std::numeric_limits<double>::infinity();
  /// Best values over the policies that finish (undiscounted) or all (discounted), shape [num_states].
  std::vector<double> best;

  /// Expected features of a policy, by dense elimination; shape [num_states, d]. @pre it finishes or is discounted.
  [[nodiscard]] Eigen::MatrixXd features(const Policy& policy) const {
    const auto n = static_cast<Eigen::Index>(mdp_.num_states());
    Eigen::MatrixXd immediate = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(mdp_.num_features()));
    for (Eigen::Index s = 0; s < n; ++s) {
      for (const Outcome& outcome : outcomes(policy, s)) {
        const auto phi = mdp_.features(outcome);
        for (std::size_t k = 0; k < phi.size(); ++k) {
          immediate(s, static_cast<Eigen::Index>(k)) += outcome.probability * phi[k];
        }
      }
    }
    const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n) - mdp_.discount() * chain(policy);
    return system.fullPivLu().solve(immediate);
  }

  [[nodiscard]] Eigen::VectorXd values(const Policy& policy) const {
    return features(policy) *
           Eigen::Map<const Eigen::VectorXd>(weights_.data(), static_cast<Eigen::Index>(weights_.size()));
  }

  /// For each state whether the policy can reach a terminal state from it.
  [[nodiscard]] std::vector<bool> can_finish(const Policy& policy) const {
    std::vector<bool> can(mdp_.num_states(), false);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t s = 0; s < can.size(); ++s) {
        if (can[s]) continue;
        for (const Outcome& outcome : outcomes(policy, static_cast<Eigen::Index>(s))) {
          if (!mdp_.is_terminal(outcome.next) && !can[outcome.next.value()]) continue;
          can[s] = changed = true;
        }
      }
    }
    return can;
  }

 private:
  [[nodiscard]] std::span<const Choice> choices(std::size_t s) const { return mdp_.choices(StateIndex{s}); }
  [[nodiscard]] std::span<const Outcome> outcomes(const Policy& policy, Eigen::Index s) const {
    const auto state = static_cast<std::size_t>(s);
    return mdp_.outcomes(choices(state)[policy[state]]);
  }

  [[nodiscard]] bool is_allowed(const Policy& policy) const {
    for (std::size_t s = 0; s < allowed_.size(); ++s) {
      if (!allowed_[s][policy[s]]) return false;
    }
    return true;
  }

  [[nodiscard]] Eigen::MatrixXd chain(const Policy& policy) const {
    const auto n = static_cast<Eigen::Index>(mdp_.num_states());
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index s = 0; s < n; ++s) {
      for (const Outcome& outcome : outcomes(policy, s)) {
        if (!mdp_.is_terminal(outcome.next))
          p(s, static_cast<Eigen::Index>(outcome.next.value())) += outcome.probability;
      }
    }
    return p;
  }

  void look_at(const Policy& policy) {
    if (best.empty()) best.assign(mdp_.num_states(), -std::numeric_limits<double>::infinity());
    const auto can = can_finish(policy);
    const bool finishes = std::ranges::all_of(can, [](bool x) { return x; });
    if (mdp_.discount() == 1.0 && !finishes) return look_at_gains(policy, can);
    const Eigen::VectorXd v = values(policy);
    for (std::size_t s = 0; s < best.size(); ++s) best[s] = std::max(best[s], v(static_cast<Eigen::Index>(s)));
  }

  // Long-run averages over the states that never finish, by squaring the lazy chain until it is at rest.
  void look_at_gains(const Policy& policy, const std::vector<bool>& can) {
    const auto n = static_cast<Eigen::Index>(mdp_.num_states());
    Eigen::MatrixXd lazy = 0.5 * (Eigen::MatrixXd::Identity(n, n) + chain(policy));
    Eigen::VectorXd reward = Eigen::VectorXd::Zero(n);
    for (Eigen::Index s = 0; s < n; ++s) {
      if (can[static_cast<std::size_t>(s)]) {
        lazy.row(s).setZero();
        continue;
      }
      for (const Outcome& outcome : outcomes(policy, s)) {
        const auto phi = mdp_.features(outcome);
        for (std::size_t k = 0; k < phi.size(); ++k) reward(s) += outcome.probability * weights_[k] * phi[k];
      }
    }
    for (int i = 0; i < 30; ++i) {
      lazy = (lazy * lazy).eval();
      for (Eigen::Index s = 0; s < n; ++s) {
        if (!can[static_cast<std::size_t>(s)]) lazy.row(s) /= lazy.row(s).sum();
      }
    }
    const Eigen::VectorXd gain = lazy * reward;
    for (Eigen::Index s = 0; s < n; ++s) {
      if (!can[static_cast<std::size_t>(s)]) highest_gain = std::max(highest_gain, gain(s));
    }
  }

  const Mdp& mdp_;
  std::span<const double> weights_;
  std::vector<std::vector<bool>> allowed_;
};

}  // namespace kith::testing
