#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "run_data.hpp"

namespace kith::detail {

// The belief spheres of up to three telling teams, which are taught again from the frozen inputs. Nothing, and a note,
// if what comes of that is not what the tables say.
// @param particles  how many points of a belief are kept, at most.
[[nodiscard]] std::optional<Json> belief_spheres(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                                 const Atlas& atlas, std::size_t particles,
                                                 std::vector<std::string>& notes);

// A team worth looking at, by position in the tables, and why.
struct TellingTeam {
  std::size_t team = 0;
  std::string why;
};
// Of the teams taught together, if there are any: the one with the lowest final knowledge, the slowest and a typical
// one, of different strategies where possible; the typical one first.
[[nodiscard]] std::vector<TellingTeam> telling_teams(const ReportDesign& design, const RunData& data);

}  // namespace kith::detail
