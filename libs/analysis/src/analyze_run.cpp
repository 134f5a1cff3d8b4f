#include <fmt/format.h>

#include <algorithm>

#include "kith/core/error.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using Response = std::pair<std::string, const std::vector<double>*>;

std::string design_note(const RunTeams& teams) {
  const auto cut_off = std::count(teams.completed.begin(), teams.completed.end(), false);
  std::string text =
      number_and_noun(teams.size(), "team") + ": " +
      (teams.strategy.levels.size() == 1 ? "1 strategy" : fmt::format("{} strategies", teams.strategy.levels.size())) +
      " x " + number_and_noun(teams.composition.levels.size(), "composition");
  for (const auto& key : teams.varied)
    text += " x " + number_and_noun(key.levels.size(), "setting") + " of " + key.name;
  if (cut_off > 0) {
    text += fmt::format("; {} reached the maximum number of periods unfinished and {} counted as {} stood", cut_off,
                        cut_off == 1 ? "is" : "are", cut_off == 1 ? "it" : "they");
  }
  return text;
}

// Why strategies cannot be compared on the same people.
std::string without_pairs(const RunTeams& teams) {
  const auto strategies = selected(teams.strategy, group_teams(teams)).levels.size();
  if (strategies < 2) return "needs at least two group strategies";
  return "the strategies taught different people (design.pairing = \"none\")";
}

}  // namespace

Analysis analyze_run(const std::filesystem::path& run_folder, const AnalysisOptions& options) {
  const auto run = PublishedRun::open(run_folder);
  const auto teams = read_teams(run);
  Analysis analysis{run_folder.string(), {design_note(teams)}};
  for (const auto& what : run.missing())
    analysis.notes.push_back("the run is incomplete, and all results describe only the teams that are there: " + what);
  const std::vector<Response> responses{{"periods", &teams.periods}, {"knowledge", &teams.knowledge}};
  // What a design allows is the same for all responses.
  const auto add = [&](auto analyse, const std::string& otherwise) {
    bool any = false;
    for (const auto& [name, values] : responses) {
      auto finding = analyse(teams, name, *values, options);
      if (!finding) continue;
      any = true;
      analysis.findings.push_back(std::move(*finding));
    }
    if (!any) analysis.not_analysed.push_back(otherwise);
  };
  add(effects, "effects of strategy and composition: needs two group strategies or two compositions");
  add(effects_within, "strategy within each composition: needs two group strategies and two compositions");
  add(paired, "same people, different strategies: " + without_pairs(teams));
  if (auto finding = demonstrations(teams, run, options)) {
    analysis.findings.push_back(std::move(*finding));
  } else {
    analysis.not_analysed.push_back("manipulation check: needs two group strategies");
  }
  add(against_baseline, "taught together or alone: needs the baseline and a group strategy");
  if (analysis.findings.empty()) {
    throw Error{{Diagnostic{.id = "E0906",
                            .message = "nothing can be compared: one strategy, one composition",
                            .file = (run_folder / "tables" / "teams.csv").string(),
                            .hint = "run a study with two strategies or two compositions",
                            .infeasible = true}}};
  }
  return analysis;
}

}  // namespace kith
