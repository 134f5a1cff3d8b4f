#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/core/text.hpp"
#include "kith/domains/domain.hpp"
#include "kith/explain/statement.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {

/// A constraint on reward weights as people would say it, with the robot's own
/// likes and dislikes on either side: for (-1, 0, 2) "crossing rubble costs more than 2 steps". Where the words of a
/// feature do not tell whether they are plural: "the cost of rubble crossings is more than the cost of 2 steps".
/// Where the robot is indifferent, because the constraint holds with equality at its weights, "at least as much as"
/// stands in place of "more than". Long normals, as expectations have them, are said as short_statement(), with its
/// condition: "if coming home is worth something, 16 steps cost more than falling into the water".
/// @param together  other constraints that are conveyed at the same time; see short_statement().
/// @return Nothing if no short statement follows from the constraint.
[[nodiscard]] std::string in_words(const Domain& domain, const HalfSpace& half_space,
                                   std::span<const HalfSpace> together = {});
/// How much a sentence for people who are taught may weigh against each other, and how long it may be.
constexpr std::size_t kMostThings = 2;
constexpr int kMostWords = 16;
/// in_words() for people who are taught: nothing if it weighs more than kMostThings, has a condition, or is longer than
/// kMostWords.
[[nodiscard]] std::string told(const Domain& domain, const HalfSpace& half_space,
                               std::span<const HalfSpace> together = {});
/// told() of constraints that are conveyed together, in their order: of short_statements(), empty where there is none.
/// @param together  further constraints that are conveyed at the same time.
[[nodiscard]] std::vector<std::string> each_in_words(const Domain& domain, std::span<const HalfSpace> half_spaces,
                                                     std::span<const HalfSpace> together = {});
/// The same without empty and repeated ones.
[[nodiscard]] std::vector<std::string> all_in_words(const Domain& domain, std::span<const HalfSpace> half_spaces);
/// What a choice changes in expectation, by the weightiest thing for it and against it: "in 10 tries it would rather
/// take 280 steps than fall into a hole 5 times". Numbers have two significant digits. kAllInAll where that would not
/// speak for the choice, and in discounted domains, where counts are none that anybody sees.
[[nodiscard]] std::string on_average_in_words(const Domain& domain, const IntegerVector& difference);
/// What a choice risks: "it risks falling into a hole", "it avoids the risk of falling into a hole"; nothing if no cost
/// that it changes in one of 100 tries is an accident: something that some action brings in less than half of the
/// cases, and most actions in less than half or never. Looks at all outcomes of the world.
/// @param difference  as above.
[[nodiscard]] std::string risk_in_words(const Domain& domain, MdpIndex world, const IntegerVector& difference);
/// The features that risk_in_words() names, ascending.
[[nodiscard]] std::vector<std::size_t> risks_of(const Domain& domain, MdpIndex world, const IntegerVector& difference);
/// The normal and the words: "(-1,0,2): crossing rubble costs more than 2 steps"; the normal alone if there are none.
[[nodiscard]] std::string described(const Domain& domain, const HalfSpace& half_space);
/// How well inferred weights explain the robot (Domain::inferred()): "the weights explain 96 % of what the robot does,
/// from which they were inferred; 20 starts are left out". Percentages are rounded down. Empty where somebody gave the
/// weights.
[[nodiscard]] std::string explained_in_words(const Domain& domain);
/// The same for people who are taught: "What it likes and dislikes explains 96 % of what it does. Only that is shown
/// here." Empty where somebody gave the weights, or where they explain everything.
[[nodiscard]] std::string explained_to_people(const Domain& domain);
/// "(-1,0,2)", without entries beyond the domain's features.
[[nodiscard]] std::string normal_text(const Domain& domain, const HalfSpace& half_space);
/// A feature n times, as a noun: "a step", "2 steps", "crossing rubble twice".
[[nodiscard]] std::string times(const Wording& wording, std::int64_t n);
/// A feature n times more than otherwise: "one more step", "2 more steps", "crossing rubble once more".
[[nodiscard]] std::string times_more(const Wording& wording, std::int64_t n);
/// A feature n times less than otherwise: "one fewer step", "2 fewer steps", "not crossing rubble".
[[nodiscard]] std::string times_fewer(const Wording& wording, std::int64_t n);
/// What the robot does, n times, as a verb: "take 2 steps"; `more`: "take 2 more steps". Empty without such words.
[[nodiscard]] std::string doing(const Wording& wording, std::int64_t n, bool more);
/// A feature in general: "steps", "crossing rubble".
[[nodiscard]] std::string in_general(const Wording& wording);
/// How often a feature counts, in few words behind a number: "step" and "steps", "rubble" and "rubble", "charger" and
/// "charger"; of a feature that is called "crossing rubble" what is crossed.
struct CountedAs {
  std::string one, many;
};
[[nodiscard]] CountedAs counted_as(const Wording& wording);
/// The robot's job in one sentence: Domain::goal() or, if the file does not say, by what ends an episode: "The robot
/// fetches the parcel and takes it to where it belongs." Empty where neither tells.
[[nodiscard]] std::string job_in_words(const Domain& domain);
/// Feature counts: "rubble 1, step 7"; "nothing" if all are zero.
[[nodiscard]] std::string counts_text(const Domain& domain, const IntegerVector& counts);
/// The return of counts in units of 1 / Domain::count_scale(), weights at length 1.
[[nodiscard]] double return_of(const Domain& domain, const IntegerVector& counts);
/// The probability that the actions of a path lead along it; nothing if that is certain.
[[nodiscard]] std::optional<double> chance_of_path(const Domain& domain, MdpIndex world, const Trajectory& path);
/// "most likely path, 12 % chance"; nothing where chance_of_path() is nothing.
[[nodiscard]] std::string chance_in_words(const Domain& domain, MdpIndex world, const Trajectory& path);
/// Actions with repetitions counted: "up, right x3".
[[nodiscard]] std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions);
/// The actions of a path. Of one that never ends the way in, the cycle once, and what that means: "right, up, down, and
/// so on: it never delivers the parcel".
[[nodiscard]] std::string actions_text(const Domain& domain, MdpIndex world, const Trajectory& path);
/// What a path that never ends misses, by what would end it: "it never delivers the parcel", "it never reaches the
/// goal"; "it never arrives" where the file does not tell. If the robot does not leave its cell any more: "it stays
/// where it is and never delivers the parcel". Empty for paths that end.
[[nodiscard]] std::string never_in_words(const Domain& domain, MdpIndex world, const Trajectory& path);
/// "(2,1)": column and row from the top left, as in everything that kith prints.
[[nodiscard]] std::string cell_text(const GridMap& map, const Cell& cell);
/// "world 3", with the name that the file gives it: "world 3 (visiting hours)".
[[nodiscard]] std::string world_text(const Domain& domain, MdpIndex m);
/// What the robot does with an action: "goes up", "picks it up", "leaves".
[[nodiscard]] std::string action_words(const std::string& action);
/// The same behind "does it": "go up", "pick it up", "leave".
[[nodiscard]] std::string action_infinitive(const std::string& action);

}  // namespace kith
