#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kith/bec/constraint_set.hpp"

namespace kith {

/// One piece of what a team is to learn: how the reward trades some features
/// against each other, taught in the MDPs that lack the masked feature.
struct KnowledgeComponent {
  std::string name;                   ///< The features weighed against the reference feature, joined by '+'.
  std::optional<std::size_t> masked;  ///< Index of the feature that must not occur; none for the last component.
  std::vector<bool> uses_mdp;         ///< Shape [num_mdps]: whether the MDP lacks the masked feature.
  ConstraintSet constraints;          ///< Minimal set of the one-step constraints of those MDPs.
  double area_sr = 0.0;               ///< Solid angle of the constraints with the prior.
};

}  // namespace kith
