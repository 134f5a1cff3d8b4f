#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"

namespace kith::detail {

// One choice per state, and the states from which it can reach a terminal state, each after one that it may lead to.
struct Policy {
  std::vector<std::uint32_t> choice;  // shape [num_states]
  std::vector<std::uint32_t> finishing;

  // Whether it finishes with probability 1 from every state.
  [[nodiscard]] bool finishes() const noexcept { return finishing.size() == choice.size(); }
};

// @pre the choices exist.
[[nodiscard]] Policy make_policy(const Mdp& mdp, std::vector<std::uint32_t> choice);

// What a policy earns from each state in the long run,
//   x = immediate + discount * P x, x = 0 at terminal states,
// for several kinds of earnings at once.
class PolicyChain {
 public:
  // `immediate` is row-major, shape [num_states, kinds].
  PolicyChain(const Mdp& mdp, const Policy& policy, std::span<const double> immediate, std::size_t kinds);

  // Gauss-Seidel sweeps outwards from the terminal states, starting with the given values, shape [num_states +
  // num_terminals, kinds]. Exact after one where the policy is deterministic and finishes. False if the values have
  // not come to rest after the last.
  [[nodiscard]] bool sweep(int most_sweeps, std::span<double> values) const;
  // As many sweeps as bring the values to rest; if they are too many, a sparse LU factorisation. False if the policy
  // ends so rarely that what it earns cannot be computed.
  // @pre the policy finishes, or the process is discounted.
  [[nodiscard]] bool solve(std::span<double> values) const;

 private:
  // One way on; a transition back to the state itself is solved for.
  struct Link {
    std::uint32_t next;  // position in order_
    double weight;       // discount * p / (1 - discount * p of staying)
  };

  void append_row(const Mdp& mdp, std::uint32_t s, const Choice& choice, std::span<const std::uint32_t> position);
  [[nodiscard]] bool factorise(std::span<double> values) const;

  std::size_t kinds_;
  std::vector<std::uint32_t> order_;       // states as they are swept
  std::vector<std::uint32_t> first_link_;  // shape [num_states + 1], by position in order_
  std::vector<Link> links_;
  std::vector<double> constant_;  // shape [num_states, kinds], by position
};

// Steps of a deterministic process, one per state (those of a policy) or one per choice.
struct PathSteps {
  std::vector<std::uint32_t> next;  // the state that it leads to
  std::vector<std::uint32_t> row;   // of the feature table
};

// Sums up along the paths of a deterministic, discounted process. It keeps the memory that this takes.
class PathWalk {
 public:
  explicit PathWalk(std::size_t num_states) : marks_(num_states, Mark::kKnown) {}

  // What the paths from some states count under a policy of these steps, each as its feature row says: exact, in one
  // pass, the cycle of a path that never ends as a geometric series.
  // @param row_counts  row-major, shape [num_feature_rows, kinds]. @param values  shape [num_states + num_terminals,
  // kinds]; those of other states are given.
  void sum_up(std::span<const std::uint32_t> states, const PathSteps& steps, std::span<const double> row_counts,
              std::size_t kinds, double discount, std::span<double> values);

 private:
  enum class Mark : unsigned char { kNew, kOnWalk, kKnown };
  template <typename Kinds>
  void sum_up_kinds(std::span<const std::uint32_t> states, const PathSteps& steps, std::span<const double> row_counts,
                    Kinds kinds, double discount, std::span<double> values);

  std::vector<Mark> marks_;  // shape [num_states]
  std::vector<std::uint32_t> walk_;
};

// The features of all rows, row-major, shape [num_feature_rows, num_features].
[[nodiscard]] inline std::span<const double> feature_rows(const Mdp& mdp) {
  if (mdp.num_feature_rows() == 0) return {};
  return {mdp.feature_row(0).data(), mdp.num_feature_rows() * mdp.num_features()};
}

// Expected (discounted) features of a policy, a function of the arguments alone, shape [num_states + num_terminals,
// num_features]; infinite where the policy ends so rarely that they cannot be computed.
[[nodiscard]] std::vector<double> policy_features(const Mdp& mdp, const Policy& policy);

// Features in units of 1 / scale, rounded to nearest. @throws kith::Error (kInfeasible) from 2^53 units on.
[[nodiscard]] IntegerVector in_units(std::span<const double> features, std::int64_t scale);

}  // namespace kith::detail
