#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/constraint_set.hpp"
#include "kith/domains/domain.hpp"

namespace kith {

/// Demonstrations that convey the same to everybody; see Atlas::start_class.
using StartClassIndex = Index<struct StartClassTag>;

/// One piece of what a team is to learn: how the reward trades some features
/// against the reference feature, taught in the MDPs that lack all others.
struct KnowledgeComponent {
  std::string name;                   ///< The features weighed against the reference feature, joined by '+'.
  std::vector<std::size_t> features;  ///< Their indices, ascending.
  std::vector<std::size_t> masked;    ///< Indices of the features that must not occur, ascending; none for the last.
  std::vector<bool> uses_mdp;         ///< Shape [num_mdps]: whether the MDP lacks the masked features.
  std::vector<StartClassIndex> start_classes;  ///< Those whose members start in such MDPs, ascending.
  ConstraintSet constraints;                   ///< Minimal set of the one-step constraints of those MDPs.
  /// Minimal set of all that demonstrations of these classes convey to anybody; nothing without BehaviourTables.
  std::optional<ConstraintSet> conveyed;
  double area_sr = 0.0;     ///< Area of the constraints with the prior on the unit sphere; sr for d = 3.
  double area_error = 0.0;  ///< Its standard error; 0 for d = 2 and 3.
};

/// The names of the masked features: "recharge", "rubble or smoke", "" for none.
[[nodiscard]] std::string masked_names(const Domain& domain, const KnowledgeComponent& component);

/// The feature that every component weighs the others against: the one that the last component does not name.
[[nodiscard]] std::size_t reference_feature(const Domain& domain, std::span<const KnowledgeComponent> components);

}  // namespace kith
