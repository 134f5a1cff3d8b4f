#pragma once

#include <nlohmann/json.hpp>

#include "kith/bec/atlas.hpp"
#include "kith/explain/bracket.hpp"
#include "kith/explain/json.hpp"
#include "kith/explain/runs.hpp"

namespace kith {

// Boards as pages animate them. Cells are [column, row] from the top left, from 1. Where a domain has neither a map nor
// a picture, legend, width, height, map and cell are left out, and a frame is {"state", "action"} with the state's
// name.

/// {"id", "title", "features": [{name, words, weight, many, do, do_many}], "counted": [{name, label, one, many}],
/// "job", "legend": [{symbol, kind, name, parts: [{kind, name}]}], "surfaces": [{name, tint, pattern}], "width",
/// "height"}. Surfaces are surfaces_of() the map. The parts of a symbol are what it puts on a cell, in the order wall,
/// terrain, station, destination, goal, start, item; kind and name are those of the first. Of the features `words` to
/// `do_many` are their Wording; `counted` is how a page counts them, counted_as(); `job` is job_in_words(), absent
/// where there is none.
[[nodiscard]] Json board_domain_json(const Domain& domain);
/// {"world", "map", "start"}: the number of the MDP, its map in the symbols of the file, and the state as a frame. Of
/// an explicit model also "world_name", if the MDP has a name, and "fences", pairs of cells, if lines are drawn between
/// some.
[[nodiscard]] Json board_json(const Domain& domain, StartId id);
/// [{"robot", "items": [{name, cell, carried}], "stations", "action", "counts"}]: entry i is the state before action i,
/// and what that step counts of each feature; the last has action null and no counts.
[[nodiscard]] Json frames_json(const Domain& domain, MdpIndex world, const Trajectory& path);
/// {"frames"}, and for a path that never ends also {"repeats_from", "repeats_text"}: the frame that the last one shows
/// again, and never_in_words().
[[nodiscard]] Json path_json(const Domain& domain, MdpIndex world, const Trajectory& path);
/// {"frame", "cell"}: where a step of a path is taken.
[[nodiscard]] Json step_json(const Domain& domain, MdpIndex world, const Trajectory& path, std::size_t step);
/// [{"normal", "text"}]
[[nodiscard]] Json sentences_json(const Domain& domain, std::span<const HalfSpace> half_spaces);
/// [{"feature", "reference", "low", "high", "ends", "text"}]: low and high are [numerator, denominator] or null, the
/// ends two texts (ends_of()), the text that of bracket_in_words().
[[nodiscard]] Json brackets_json(const Domain& domain, std::span<const Bracket> brackets);
/// {"text", "runs": [{"frames", "ended"}]}: what happened in how many of all runs, and typical_runs(); null if there
/// are none, as where nothing is left to chance.
[[nodiscard]] Json runs_json(const Domain& domain, MdpIndex world, const std::vector<PolicyRun>& runs);

}  // namespace kith
