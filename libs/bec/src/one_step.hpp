#pragma once

#include <vector>

#include "kith/bec/constraint_table.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

// The one-step deviation constraints of one MDP (Brown & Niekum 2019, with the
// deviating action included at every state of the path).

// mu_robot(s) - mu(s, b) != 0 for every action b of state s, as numbers in `table`.
[[nodiscard]] std::vector<ConstraintIndex> deviations(const Mdp& mdp, const ExactSolution& robot, StateIndex s,
                                                      ConstraintTable& table);

// How many actions of `s` are optimal.
[[nodiscard]] std::size_t num_optimal_choices(const Mdp& mdp, const ExactSolution& robot, const IntegerVector& weights,
                                              StateIndex s);

// The states 0 .. num_states-1 so that every state comes after its successor on the canonical path.
[[nodiscard]] std::vector<StateIndex> successors_first(const Mdp& mdp, const ExactSolution& robot);

// The next state of the canonical path; may be terminal.
[[nodiscard]] StateIndex next_state(const Mdp& mdp, const ExactSolution& robot, StateIndex s);

}  // namespace kith
