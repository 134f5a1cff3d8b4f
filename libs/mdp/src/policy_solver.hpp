#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/mdp/mdp.hpp"
#include "path_values.hpp"
#include "policy_evaluation.hpp"

namespace kith::detail {

// Optimal values of any Mdp under one reward, among the choices of a mask.
//
// Undiscounted, it optimises over the policies that finish. Policy iteration
// from one of them passes through such policies only, each better than the one
// before, unless some policy that never finishes gains per step: the first one
// met that does not finish proves it [bertsekas1991]. That stays so if a policy
// is only evaluated by a few sweeps, from values that it improves: they rise
// towards what it earns. The last one is evaluated fully. Policies of deterministic,
// discounted processes are always evaluated fully, in one pass.
// The arguments are kept by reference.
class PolicySolver {
 public:
  PolicySolver(const Mdp& mdp, std::span<const double> row_rewards, double tolerance, const ChoiceMask& mask);

  // Optimal values, shape [num_states + num_terminals]. Nothing if there is no finite optimum.
  [[nodiscard]] std::optional<std::vector<double>> optimal_values() const;
  // The choices of the mask that are optimal within the tolerance, given optimal values.
  [[nodiscard]] ChoiceMask tight_choices(std::span<const double> values) const;

 private:
  [[nodiscard]] bool is_allowed(std::size_t choice) const { return mask_.empty() || mask_[choice] != 0; }
  [[nodiscard]] double worth(const Choice& choice, std::span<const double> values) const;
  [[nodiscard]] PolicyChain chain_of(const Policy& policy) const;
  [[nodiscard]] bool improve(Policy& policy, std::span<const double> values) const;

  const Mdp& mdp_;
  std::span<const double> rewards_;
  double tolerance_;
  const ChoiceMask& mask_;
  PathSteps steps_;  // of a deterministic, discounted process, else empty
};

// The first choice of the mask in every state; states from which this does not lead to an end take the first choice
// that leads to a state which does, as far as there is one. @pre the mask has a choice in every state.
[[nodiscard]] Policy first_finishing(const Mdp& mdp, const ChoiceMask& mask);
// The policy that goes to an end by the most probable outcomes. @pre the mask has a choice in every state.
[[nodiscard]] Policy likeliest_finishing(const Mdp& mdp, const ChoiceMask& mask);
// Whether the policy takes the first choice of the mask everywhere.
[[nodiscard]] bool takes_first(const Mdp& mdp, const ChoiceMask& mask, const Policy& policy);

}  // namespace kith::detail
