#pragma once

#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// A constraint on reward weights as people would say it, with the robot's own
/// likes and dislikes on either side: for (-1, 0, 2) "crossing rubble costs more than 2 steps". Where the words of a
/// feature do not tell whether they are plural: "the cost of rubble crossings is more than the cost of 2 steps".
[[nodiscard]] std::string in_words(const Domain& domain, const HalfSpace& half_space);
/// The normal and the words: "(-1,0,2): crossing rubble costs more than 2 steps".
[[nodiscard]] std::string described(const Domain& domain, const HalfSpace& half_space);
/// "(-1,0,2)", without entries beyond the domain's features.
[[nodiscard]] std::string normal_text(const Domain& domain, const HalfSpace& half_space);
/// Feature counts: "rubble 1, step 7"; "nothing" if all are zero.
[[nodiscard]] std::string counts_text(const Domain& domain, const IntegerVector& counts);
/// "1 team", "6 teams".
[[nodiscard]] std::string counted(std::size_t n, const std::string& noun);
/// Actions with repetitions counted: "up, right x3".
[[nodiscard]] std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions);

}  // namespace kith
