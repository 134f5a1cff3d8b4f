#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kith/analysis/exports.hpp"
#include "kith/core/error.hpp"
#include "kith/files/document.hpp"
#include "model_means.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

std::string design_note(const RunTeams& teams) {
  const auto skipped = std::ranges::count(teams.records, SessionStatus::kSkipped, &TeamRecord::status);
  const auto cut_off = std::ranges::count(teams.records, false, &TeamRecord::completed) - skipped;
  std::string text =
      counted(teams.size(), "team") + ": " +
      (teams.strategy.levels.size() == 1 ? "1 strategy" : fmt::format("{} strategies", teams.strategy.levels.size())) +
      " x " + counted(teams.composition.levels.size(), "composition");
  for (const auto& key : teams.varied) text += " x " + counted(key.levels.size(), "setting") + " of " + key.name;
  if (cut_off > 0) {
    text += fmt::format("; {} reached the maximum number of periods unfinished and {} counted as {} stood", cut_off,
                        cut_off == 1 ? "is" : "are", cut_off == 1 ? "it" : "they");
  }
  if (skipped > 0) {
    text += fmt::format("; of {} nothing that could be shown conveyed the rest of a component, and {} counted likewise",
                        skipped, skipped == 1 ? "is" : "are");
  }
  return text;
}

// Why strategies cannot be compared on the same people.
std::string without_pairs(const RunTeams& teams) {
  const auto strategies = selected(teams.strategy, group_teams(teams)).levels.size();
  if (strategies < 2) return "needs at least two group strategies";
  return "the strategies taught different people (design.pairing = \"none\")";
}

// The [[contrast]]s of the study file that the run was made from. That file was checked when the study was read.
std::vector<PlannedContrast> contrasts_of(const PublishedRun& run) {
  const std::string file = "inputs/study.toml";
  std::vector<PlannedContrast> contrasts;
  if (!run.has(file)) return contrasts;
  const auto parsing = parse_toml(run.read(file), file);
  const auto* value = parsing.document ? parsing.document->root.find("contrast") : nullptr;
  if (value == nullptr || value->array() == nullptr) return contrasts;

  const auto text = [](const TomlTable& table, const char* key) {
    const auto* found = table.find(key);
    return found != nullptr && found->string() != nullptr ? *found->string() : std::string{};
  };

  for (const auto& element : *value->array()) {
    const auto* table = element.table();
    const auto* weights = table != nullptr ? table->find("weights") : nullptr;
    if (weights == nullptr || weights->table() == nullptr) continue;
    const auto* primary = table->find("primary");
    PlannedContrast contrast{.name = text(*table, "name"),
                             .factor = text(*table, "factor"),
                             .response = text(*table, "response"),
                             .primary = primary != nullptr && primary->boolean() != nullptr && *primary->boolean()};

    for (const auto& entry : weights->table()->entries()) {
      const auto* real = entry.value.real();
      const auto* integer = entry.value.integer();
      if (real != nullptr) contrast.weights.push_back({entry.key, *real});
      if (integer != nullptr) contrast.weights.push_back({entry.key, static_cast<double>(*integer)});
    }
    contrasts.push_back(std::move(contrast));
  }
  return contrasts;
}

// What was published of the run before teams were added, as its manifest says.
std::vector<std::string> grown_from(const PublishedRun& run) {
  return nlohmann::json::parse(run.manifest()).value("grown", std::vector<std::string>{});
}

// The same options with the exploratory contrasts of one response.
AnalysisOptions for_response(AnalysisOptions options, const std::string& response) {
  const auto is_other = [&](const PlannedContrast& one) {
    return one.primary || (!one.response.empty() && one.response != response);
  };
  options.contrasts.erase(std::remove_if(options.contrasts.begin(), options.contrasts.end(), is_other),
                          options.contrasts.end());
  return options;
}

}  // namespace

Analysis analyze_run(const std::filesystem::path& run_folder, const AnalysisOptions& options) {
  const auto run = PublishedRun::open(run_folder);
  const auto teams = read_teams(run);
  Analysis analysis{run_folder.string(), {design_note(teams)}};
  for (const auto& what : run.missing())
    analysis.notes.push_back("the run is incomplete, and all results describe only the teams that are there: " + what);
  for (const auto& before : grown_from(run))
    analysis.notes.push_back("the run had " + before +
                             ", and teams were added later: a plan that says that no team is added after a test does "
                             "not cover tests of all of them if those were analysed");
  const auto responses = outcomes_of(teams);
  // What a design allows is the same for all responses.
  const auto model = team_model(teams, group_teams(teams), responses.front().first, responses.front().second);
  check_comparisons(model.factors, options);
  auto planned = options;
  for (auto& contrast : contrasts_of(run)) {
    if (is_testable(model.factors, contrast)) {
      planned.contrasts.push_back(std::move(contrast));
    } else {
      analysis.not_analysed.push_back("contrast '" + contrast.name +
                                      "' of the study: its levels are not all among the teams taught together");
    }
  }
  const auto add = [&](const RunTeams& some, const Outcomes& outcomes, auto analyse, const std::string& otherwise) {
    bool any = false;
    for (const auto& [name, values] : outcomes) {
      auto finding = analyse(some, name, values, for_response(planned, name));
      if (!finding) continue;
      any = true;
      analysis.findings.push_back(std::move(*finding));
    }
    if (!any) analysis.not_analysed.push_back(otherwise);
  };
  const auto [once, means] = over_settings(teams, responses);
  if (auto finding = primary(once, means, planned.contrasts, options)) {
    analysis.notes.emplace_back(
        "the study was planned to test its primary contrasts, which come first and are corrected among themselves; "
        "everything else is exploratory");
    analysis.findings.push_back(std::move(*finding));
  }
  add(teams, responses, effects, "effects of strategy and composition: needs two group strategies or two compositions");
  add(once, means, effects_within, "strategy within each composition: needs two group strategies and two compositions");
  add(once, means, beliefs,
      "team beliefs against individual beliefs: needs a strategy for the team's belief (common, joint) and one "
      "for a member's (individual-low, individual-high)");
  for (const auto& [name, values] : responses) {
    if (auto finding = variation(teams, name, values, options)) analysis.findings.push_back(std::move(*finding));
  }
  add(once, means, paired, "same people, different strategies: " + without_pairs(teams));
  if (auto finding = demonstrations(teams, run, options)) {
    analysis.findings.push_back(std::move(*finding));
  } else {
    analysis.not_analysed.push_back("manipulation check: needs two group strategies");
  }
  add(once, means, against_baseline, "taught together or alone: needs the baseline and a group strategy");
  if (analysis.findings.empty()) {
    throw Error{{Diagnostic{.id = "E0906",
                            .message = "nothing can be compared: one strategy, one composition",
                            .file = (run_folder / "tables" / "teams.csv").string(),
                            .hint = "run a study with two strategies or two compositions",
                            .infeasible = true}}};
  }
  for (auto& finding : analysis.findings) finding.results = results_paragraph(finding, options.alpha);
  return analysis;
}

}  // namespace kith
