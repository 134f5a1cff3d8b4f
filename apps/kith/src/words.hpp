#pragma once

#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/planner.hpp"

namespace kith::cli {

/// A constraint on reward weights as people would say it, with the robot's own
/// likes and dislikes on either side: for (-1, 0, 2) "crossing rubble costs more than 2 steps".
[[nodiscard]] std::string in_words(const Domain& domain, const HalfSpace& half_space);
/// The normal and the words: "(-1,0,2): crossing rubble costs more than 2 steps".
[[nodiscard]] std::string described(const Domain& domain, const HalfSpace& half_space);
/// "(-1,0,2)", without entries beyond the domain's features.
[[nodiscard]] std::string normal_text(const Domain& domain, const HalfSpace& half_space);
/// Feature counts: "1 rubble, 7 step"; "nothing" if all are zero.
[[nodiscard]] std::string counts_text(const Domain& domain, const IntegerVector& counts);
/// Actions with repetitions counted: "up, right x3".
[[nodiscard]] std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions);

}  // namespace kith::cli
