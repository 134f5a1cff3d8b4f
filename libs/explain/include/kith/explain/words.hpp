#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// A constraint on reward weights as people would say it, with the robot's own
/// likes and dislikes on either side: for (-1, 0, 2) "crossing rubble costs more than 2 steps". Where the words of a
/// feature do not tell whether they are plural: "the cost of rubble crossings is more than the cost of 2 steps".
/// Where the robot is indifferent, because the constraint holds with equality at its weights, "at least as much as"
/// stands in place of "more than". Long normals, as expectations have them, are said as in_small_numbers().
[[nodiscard]] std::string in_words(const Domain& domain, const HalfSpace& half_space);
/// The constraint itself if no entry exceeds 1000, else one of small numbers that follows from it for everybody who
/// agrees with the robot on what is a cost and what is a gain: the heavier side is rounded up and the lighter one down,
/// and no term of the heavier side is left out.
[[nodiscard]] HalfSpace in_small_numbers(const Domain& domain, const HalfSpace& half_space);
/// What a choice changes in expectation: "on average its choice saves falling into a hole 0.80 times and costs 1.67
/// steps". Differences below 0.005 are left out.
/// @param difference  the robot's counts minus the other ones, in units of 1 / Domain::count_scale(), shape [d].
[[nodiscard]] std::string on_average_in_words(const Domain& domain, const IntegerVector& difference);
/// The normal and the words: "(-1,0,2): crossing rubble costs more than 2 steps".
[[nodiscard]] std::string described(const Domain& domain, const HalfSpace& half_space);
/// "(-1,0,2)", without entries beyond the domain's features.
[[nodiscard]] std::string normal_text(const Domain& domain, const HalfSpace& half_space);
/// A feature n times, as a noun: "a step", "2 steps", "crossing rubble twice".
[[nodiscard]] std::string times(const Wording& wording, std::int64_t n);
/// A feature n times more than otherwise: "one more step", "2 more steps", "crossing rubble once more".
[[nodiscard]] std::string times_more(const Wording& wording, std::int64_t n);
/// What the robot does, n times, as a verb: "take 2 steps"; `more`: "take 2 more steps". Empty without such words.
[[nodiscard]] std::string doing(const Wording& wording, std::int64_t n, bool more);
/// A feature in general: "steps", "crossing rubble".
[[nodiscard]] std::string in_general(const Wording& wording);
/// Feature counts: "rubble 1, step 7"; "nothing" if all are zero.
[[nodiscard]] std::string counts_text(const Domain& domain, const IntegerVector& counts);
/// The return of counts in units of 1 / Domain::count_scale(), weights at length 1.
[[nodiscard]] double return_of(const Domain& domain, const IntegerVector& counts);
/// "1 team", "6 teams".
[[nodiscard]] std::string counted(std::size_t n, const std::string& noun);
/// "likeliest path, chance 12 %" for a path that other outcomes could change, else nothing.
[[nodiscard]] std::string chance_in_words(const Domain& domain, MdpIndex world, const Trajectory& path);
/// Actions with repetitions counted: "up, right x3".
[[nodiscard]] std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions);
/// "a", "a and b", "a, b and c".
[[nodiscard]] std::string listed(const std::vector<std::string>& things);
/// "(2,1)": column and row from the top left, as in everything that kith prints.
[[nodiscard]] std::string cell_text(const GridMap& map, const Cell& cell);
/// What the robot does with an action: "goes up", "picks it up", "leaves".
[[nodiscard]] std::string action_words(const std::string& action);
/// The same behind "does it": "go up", "pick it up", "leave".
[[nodiscard]] std::string action_infinitive(const std::string& action);

}  // namespace kith
