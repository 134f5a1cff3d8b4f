#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kith/explain/move_table.hpp"
#include "kith/live/live_study.hpp"
#include "kith/mdp/planner.hpp"
#include "kith/teaching/lesson.hpp"

namespace kith {

/// The most states of a world that people can be asked about: its table of moves is sent to browsers.
inline constexpr std::size_t kMaxLiveStates = 20'000;

/// Names a world in GET /api/world/KEY: "<study's key>-<number>". Equal keys mean equal tables, so answers can be
/// cached.
[[nodiscard]] std::string world_key(const LiveStudy& study, MdpIndex world);
/// The world of a key; nothing if there is none.
[[nodiscard]] std::optional<MdpIndex> world_of_key(const LiveStudy& study, std::string_view key);

/// The table of moves of a world: move_table_json() with "key" and "max_actions", max_answer_actions().
[[nodiscard]] Json world_json(const LiveStudy& study, MdpIndex world);
/// For a page on which the robot can be changed: {"explore": what people see who explore, or null where the map is too
/// large, "learn": between which bounds the weights lie for whoever has learned everything: brackets_json()}.
/// @param asked  {"start": a frame, "map": rows, unless it is that of the domain}, or null.
[[nodiscard]] Json playground_json(const LiveStudy& study, const Json& asked);

/// The number of a state in that table; states that nothing leads to have none.
[[nodiscard]] std::optional<std::size_t> world_state(const LiveStudy& study, MdpIndex world, StateIndex state);

/// What a person's list of actions is.
struct JudgedPath {
  bool is_legal = true;      ///< Every action did something, none came after the end, and there were not too many.
  bool is_too_long = false;  ///< It is not legal because there were more than max_answer_actions().
  std::size_t legal = 0;     ///< Actions before the first that was not.
  Trajectory path{};         ///< The legal actions; where chance has a part each leads to its likeliest outcome.
  bool is_finished = false;  ///< The end was reached, or it is said to go on for ever where later steps count less.
  /// What is judged: the path's feature counts; where chance has a part the expected counts if the robot takes these
  /// actions for as long as it is where the person expected it, and its own from then on. Nothing unless the path is
  /// finished.
  Answer counts{};
};

/// Judges nothing but whether the path is possible, and counts its features. See docs/model.md.
/// @param actions  numbers of actions, as in the table of moves.
/// @param for_ever  the path goes round for ever, from when it was last in the state in which it stops; it is not legal
/// unless it was there before. In undiscounted worlds it counts as one that stops short of the end.
[[nodiscard]] JudgedPath judged_path(const Atlas& atlas, StartIndex test, std::span<const std::size_t> actions,
                                     bool for_ever = false);

/// The robot's own way from a start if every action leads to its likeliest outcome: what a right answer looks like on a
/// page. Nothing if people could not enter it: it does not come to an end within the actions that an answer may have.
/// With chance the likeliest outcomes may lead round in a circle, where the robot itself leaves by a less likely one;
/// without, a robot that goes round for ever can be answered so.
[[nodiscard]] std::optional<Trajectory> answerable_path(const Atlas& atlas, StartIndex test);

/// The same, or Atlas::trajectory() where there is none.
[[nodiscard]] Trajectory expected_path(const Atlas& atlas, StartIndex test);

}  // namespace kith
