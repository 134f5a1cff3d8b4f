#pragma once

#include <vector>

#include "domain_data.hpp"
#include "dynamics.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/files/reader.hpp"
#include "kith/mdp/planner.hpp"
#include "reward.hpp"

namespace kith::detail {

// Explores and checks every MDP of the family. Reports what makes the family
// infeasible or too large; the result is complete only without errors.
[[nodiscard]] std::vector<DomainMember> build_family(const FamilyMap& family_map, const Dynamics& dynamics,
                                                     const DomainLimits& limits, TomlReport& report);

// Reports MDPs in which the robot has no finite optimum, ties that matter, and
// optimal paths longer than max_steps. Needs integral features and discount 1.
void check_optimum(const FamilyMap& family_map, const Dynamics& dynamics, const Reward& reward,
                   const std::vector<DomainMember>& members, TomlReport& report);

// States from which equally good paths have different feature counts. `solution` is the plan under the weights.
[[nodiscard]] std::size_t count_ties(const Mdp& mdp, const ExactSolution& solution, const IntegerVector& weights);
void warn_of_ties(std::size_t num_ties, const TomlPlace& weights_place, TomlReport& report);

// Reports explicit models in which the robot has no finite optimum, and ties that matter. `data` has the weights.
void check_model(const ExplicitFamily& family, const Domain::Data& data, const Dynamics& dynamics,
                 const TomlPlace& weights_place, TomlReport& report);

}  // namespace kith::detail
