#include <fmt/format.h>

#include <algorithm>

#include "kith/core/error.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using Response = std::pair<std::string, const std::vector<double>*>;

std::string design_note(const RunTeams& teams) {
  const auto cut_off = std::count(teams.completed.begin(), teams.completed.end(), false);
  std::string text = fmt::format("{} teams: {} strategies x {} compositions", teams.size(),
                                 teams.strategy.levels.size(), teams.composition.levels.size());
  for (const auto& key : teams.varied) text += fmt::format(" x {} settings of {}", key.levels.size(), key.name);
  if (cut_off > 0)
    text += fmt::format("; {} reached the largest number of periods unfinished and are counted as they stood", cut_off);
  return text;
}

}  // namespace

Analysis analyze_run(const std::filesystem::path& run_folder, const AnalysisOptions& options) {
  const auto run = PublishedRun::open(run_folder);
  const auto teams = read_teams(run);
  Analysis analysis{run_folder.string(), {design_note(teams)}, {}};
  for (const auto& what : run.missing())
    analysis.notes.push_back("the run is not complete, and every figure is about the teams that are there: " + what);
  const auto add = [&](std::optional<Finding> finding, const std::string& otherwise) {
    if (finding) {
      analysis.findings.push_back(std::move(*finding));
    } else {
      analysis.notes.push_back(otherwise);
    }
  };
  const std::vector<Response> responses{{"periods", &teams.periods}, {"knowledge", &teams.knowledge}};
  for (const auto& [name, values] : responses)
    add(effects(teams, name, *values, options), name + ": no factor has two levels, so there is nothing to compare");
  for (const auto& [name, values] : responses)
    add(effects_within(teams, name, *values, options),
        name + " within compositions: needs two strategies and two compositions");
  for (const auto& [name, values] : responses)
    add(paired(teams, name, *values, options),
        name + ": no two strategies taught the same people, so there are no pairs");
  add(demonstrations(teams, run, options), "manipulation check: needs two group strategies");
  for (const auto& [name, values] : responses)
    add(against_baseline(teams, name, *values, options),
        name + ": no comparison with the baseline without baseline and groups");
  if (analysis.findings.empty()) {
    throw Error{{Diagnostic{.id = "E0906",
                            .message = "nothing can be compared: one strategy, one composition",
                            .file = (run_folder / "tables" / "teams.csv").string(),
                            .hint = "run a study with two of either",
                            .infeasible = true}}};
  }
  return analysis;
}

}  // namespace kith
