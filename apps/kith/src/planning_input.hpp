#pragma once

#include <string>
#include <vector>

#include "kith/analysis/findings.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/study/study.hpp"

namespace kith::cli {

/// @throws kith::Error (E0812) if keys vary within the study.
void check_single_variant(const std::string& name, const Study& study);

/// The findings of a targets file, "-" for standard input. @throws kith::Error with all that is wrong.
[[nodiscard]] std::vector<PublishedFinding> findings_of(const std::string& file, const StudySpec& spec);

/// One team of every cell, simulated to know what a study comes to.
struct Trial {
  double seconds_per_team = 0.0;
  std::vector<TeamRecord> teams;
};
[[nodiscard]] Trial try_cells(const Atlas& atlas, const StudySpec& spec, std::size_t threads);
/// "simulating 6000 teams takes about 12 s". @param teams  in all.
[[nodiscard]] std::string work_text(const Trial& trial, std::size_t teams);
/// "demonstrations and tests of a session, in a team of every composition: joint 31 to 40, plan 20".
[[nodiscard]] std::string items_text(const Trial& trial, const StudySpec& spec);

/// "less than a second", "about 12 s", "about 3 min", "about 2.5 h".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace kith::cli
