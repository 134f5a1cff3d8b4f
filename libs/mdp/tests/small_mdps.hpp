#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/mdp/mdp.hpp"

// Small processes, made by hand or at random, and oracles that enumerate what
// the library computes cleverly.
namespace kith::testing {

struct Edge {
  std::size_t from;
  std::size_t action;
  std::size_t next;
  std::vector<double> features;
};

/// A deterministic process from its edges, listed by state and action.
inline Mdp make_mdp(std::size_t num_states, std::size_t num_terminals, const std::vector<Edge>& edges,
                    double discount = 1.0) {
  std::size_t num_actions = 1;
  for (const Edge& edge : edges) num_actions = std::max(num_actions, edge.action + 1);
  MdpBuilder builder{num_states, num_terminals, num_actions, edges.at(0).features.size(), discount};
  for (const Edge& edge : edges) {
    const MdpBuilder::Transition transition{StateIndex{edge.next}, 1.0, edge.features};
    builder.add_choice(StateIndex{edge.from}, ActionIndex{edge.action}, std::span{&transition, 1});
  }
  return std::move(builder).build();
}

/// 0 -> {1, 2} -> terminal 3; both ways have the same features in another order.
inline Mdp diamond() {
  return make_mdp(3, 1, {{0, 1, 2, {0, 1}}, {0, 2, 1, {1, 0}}, {1, 0, 3, {0, 1}}, {2, 0, 3, {1, 0}}});
}

/// 0 <-> 1 -> terminal 2; the round trip has features (1, 2).
inline Mdp round_trip() { return make_mdp(2, 1, {{0, 0, 1, {1, 1}}, {1, 0, 0, {0, 1}}, {1, 1, 2, {0, 1}}}); }

inline std::int64_t uniform_integer(std::int64_t low, std::int64_t high, RandomStream& random) {
  return low + static_cast<std::int64_t>(uniform_index(static_cast<std::size_t>(high - low + 1), random));
}

inline IntegerVector random_vector(std::int64_t low, std::int64_t high, RandomStream& random) {
  return {uniform_integer(low, high, random), uniform_integer(low, high, random), uniform_integer(low, high, random)};
}

/// How many of random_mdp() a law is tried on.
inline constexpr int kNumRandom = 3000;

/// For random_mdp(): under some of them it pays never to finish.
inline IntegerVector random_weights(RandomStream& random) {
  return {uniform_integer(-4, 2, random), uniform_integer(-4, 4, random), uniform_integer(-6, 1, random)};
}

/// Deterministic, three features, at most `most_states` states and three
/// actions. One in three has features of either sign; in the others the last
/// feature counts steps. Dead ends and stranded states occur.
inline Mdp random_mdp(std::size_t most_states, RandomStream& random) {
  const std::size_t num_states = 1 + uniform_index(most_states, random);
  const std::size_t num_terminals = 1 + uniform_index(2, random);
  const bool counts_steps = uniform_index(3, random) != 0;
  std::vector<Edge> edges;
  for (std::size_t s = 0; s < num_states; ++s) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t next = uniform_index(num_states + num_terminals, random);
      if (next == s || uniform01(random) < 0.1) continue;
      const IntegerVector phi = counts_steps ? random_vector(0, 2, random) : random_vector(-1, 1, random);
      const double last = counts_steps ? 1.0 : static_cast<double>(phi[2]);
      edges.push_back({s, a, next, {static_cast<double>(phi[0]), static_cast<double>(phi[1]), last}});
    }
  }
  if (edges.empty()) edges.push_back({0, 0, num_states, {0.0, 0.0, 1.0}});
  return make_mdp(num_states, num_terminals, edges);
}

inline const Outcome& outcome(const Mdp& mdp, StateIndex s, std::size_t choice) {
  return mdp.outcomes(mdp.choices(s)[choice]).front();
}

/// Calls visit(choice per state) for every deterministic policy; a state without choices keeps 0.
template <typename Visit>
void for_each_policy(const Mdp& mdp, const Visit& visit) {
  std::vector<std::uint32_t> policy(mdp.num_states(), 0);
  for (;;) {
    visit(std::as_const(policy));
    std::size_t s = 0;
    while (s < policy.size() && ++policy[s] >= mdp.choices(StateIndex{s}).size()) policy[s++] = 0;
    if (s == policy.size()) return;
  }
}

/// Where a policy leads from `start`: the features of the way to a terminal
/// state, or of the cycle that it ends up in.
struct Rollout {
  bool finishes = false;
  bool is_stuck = false;  ///< In a dead end.
  IntegerVector features;
};

inline Rollout roll_out(const Mdp& mdp, std::span<const std::uint32_t> policy, std::size_t start) {
  IntegerVector sum(mdp.num_features());
  std::vector<IntegerVector> sum_at(mdp.num_states());
  std::vector<bool> seen(mdp.num_states(), false);
  std::size_t s = start;
  while (s < mdp.num_states() && !seen[s]) {
    if (mdp.choices(StateIndex{s}).empty()) return {.is_stuck = true, .features = sum};
    seen[s] = true;
    sum_at[s] = sum;
    const Outcome& step = outcome(mdp, StateIndex{s}, policy[s]);
    sum += mdp.integer_features(step);
    s = step.next.value();
  }
  if (s >= mdp.num_states()) return {.finishes = true, .features = sum};
  return {.features = sum - sum_at[s]};
}

/// The feature sums of all simple cycles (with repetitions).
inline std::vector<IntegerVector> all_cycles(const Mdp& mdp) {
  std::vector<IntegerVector> cycles;
  for_each_policy(mdp, [&](const std::vector<std::uint32_t>& policy) {
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const Rollout rollout = roll_out(mdp, policy, s);
      if (!rollout.finishes && !rollout.is_stuck) cycles.push_back(rollout.features);
    }
  });
  return cycles;
}

/// The feature counts of all simple paths from `start` to a terminal state (with repetitions).
inline std::vector<IntegerVector> all_paths(const Mdp& mdp, std::size_t start) {
  std::vector<IntegerVector> paths;
  for_each_policy(mdp, [&](const std::vector<std::uint32_t>& policy) {
    const Rollout rollout = roll_out(mdp, policy, start);
    if (rollout.finishes) paths.push_back(rollout.features);
  });
  return paths;
}

inline std::vector<double> to_real(const IntegerVector& v) { return {v.begin(), v.end()}; }

}  // namespace kith::testing
