#pragma once

#include "kith/bec/atlas.hpp"
#include "kith/explain/json.hpp"

namespace kith {

/// The likeliest outcome that changes the state: an action that mostly has no effect can still be worth trying.
[[nodiscard]] const Outcome& likeliest_outcome(const Mdp& mdp, StateIndex s, const Choice& choice);

/// The most actions of an answer: what the domain allows for a path, Domain::max_steps(), and at most 500, whatever it
/// allows. The table of moves tells pages, which say so before somebody gets there.
[[nodiscard]] std::size_t max_answer_actions(const Domain& domain);

/// phi of an outcome, one number for each feature.
[[nodiscard]] Json counts_json(const Mdp& mdp, const Outcome& outcome);

/// The moves of a world and what they count, for pages on which somebody drives the robot:
///   {"actions": [{"name", "label", "dx", "dy"}], "items": [name], "stations": [[column, row]], "frames": [FRAME],
///    "next": [[state | -1 per action]], "end": [bool], "counts": [text],
///    "kinds": [[count per feature]], "chance": bool, "may_repeat": bool,
///    "outcomes": [[[[next, probability, counts], ...] | null per action]], only where chance has a part}
/// States are numbers of this table. Frames are [robotColumn, robotRow, [[column, row, carried 0|1], ...],
/// [index into stations, ...]], without a map {"state": name}. -1: nothing happens. Where chance has a part, next is
/// the likeliest outcome that changes the state, and counts are its: a character per action, '0' for the first of
/// kinds, '1' for the second and so on, '-' where nothing happens. dx and dy are how the action moves the robot, row
/// numbers growing downward; null for actions that do not move it. may_repeat: an answer may be a path that never ends.
/// Nothing in it tells anything about the reward.
[[nodiscard]] Json move_table_json(const Domain& domain, MdpIndex world);

/// The same with what a page needs to judge answers itself: nothing more in exact domains; in others also
///   {"outcomes", "robot": [its action],
///    "ahead": [feature counts of the robot from there on, in units of 1 / Domain::count_scale()]}
/// of every state that does not end.
[[nodiscard]] Json judged_table_json(const Atlas& atlas, MdpIndex world);

/// By what judge_path() judges: {"exact", "weights": integers as texts, "unit": weights of length 1, "scale":
/// Domain::count_scale(), "discount"}.
[[nodiscard]] Json judge_json(const Domain& domain);

}  // namespace kith
