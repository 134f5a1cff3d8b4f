#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"
#include "policy_evaluation.hpp"

namespace kith::detail {

// One byte per choice of the Mdp, in the order of Mdp::first_choice(); empty: all.
using ChoiceMask = std::vector<unsigned char>;

// What every choice of a deterministic process does, shape [num_choices]: far less memory to go through than that of
// outcomes.
[[nodiscard]] PathSteps steps_of_choices(const Mdp& mdp);

// The states, nearest to a terminal one first, then those that cannot reach one.
[[nodiscard]] std::vector<std::uint32_t> states_by_distance(const Mdp& mdp);

// Optimal values of a deterministic, discounted Mdp under one reward, among the choices of a mask: of all its states,
// or of some after the others that they lead to. The arguments are kept by reference.
class PathValues {
 public:
  PathValues(const Mdp& mdp, const PathSteps& steps, std::span<const double> row_rewards, double tolerance,
             const ChoiceMask& mask);

  // Finds the values of these states, given those of the others that their choices lead to. The order is that in which
  // they are improved.
  void solve(std::span<const std::uint32_t> states);
  void set_value(std::size_t s, double value) { values_[s] = value; }
  // shape [num_states + num_terminals]; 0 at terminal states.
  [[nodiscard]] std::vector<double>& values() noexcept { return values_; }

  // Whether a choice of the mask is optimal within the tolerance.
  [[nodiscard]] bool is_tight_choice(std::size_t s, std::size_t c) const;
  // From now on the policy takes the first choices that are tight.
  void take_first_tight(std::span<const std::uint32_t> states);
  // sum_up_paths() of the policy, of these states; the counts of the others that they lead to are given.
  void sum_up(std::span<const std::uint32_t> states, std::span<const double> row_counts, std::size_t kinds,
              std::span<double> counts);

 private:
  [[nodiscard]] bool is_allowed(std::size_t choice) const { return mask_.empty() || mask_[choice] != 0; }
  [[nodiscard]] double worth(std::size_t choice) const {
    return rewards_[steps_.row[choice]] + mdp_.discount() * values_[steps_.next[choice]];
  }
  void take(std::size_t s, std::size_t choice);
  template <typename Admits>
  bool choose(std::size_t s, double least, const Admits& admits);

  const Mdp& mdp_;
  const PathSteps& steps_;
  std::span<const double> rewards_;
  double tolerance_;
  const ChoiceMask& mask_;
  PathSteps policy_;
  std::vector<double> values_;
  std::vector<double> before_;          // values of the states that are solved
  std::vector<unsigned char> is_open_;  // to be looked at again, or without a value; shape [num_states + num_terminals]
  PathWalk walk_;
};

}  // namespace kith::detail
