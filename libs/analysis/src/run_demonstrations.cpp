#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "kith/analysis/moments.hpp"
#include "kith/files/column_names.hpp"
#include "kith/study/read_records.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// "from -2.1 (joint) to -1.8 (common)": from the strategy that conveys most (the smallest area) to the one that conveys
// least.
std::string range_of(const std::vector<double>& values, const Factor& strategy) {
  std::vector<std::pair<double, std::string>> means;
  const auto groups = split_by(values, strategy);
  for (std::size_t level = 0; level < groups.size(); ++level) {
    means.emplace_back(mean(groups[level]), strategy.levels[level]);
  }
  const auto [least, most] = std::minmax_element(means.begin(), means.end());
  return fmt::format("from {:.3f} ({}) to {:.3f} ({})", least->first, least->second, most->first, most->second);
}

// Adds the tables of one component, and returns the test of the strategies.
Estimable<TestResult> add_component(const ModelData& one, const AnalysisOptions& options, const std::string& about,
                                    Finding& finding) {
  if (one.groups.empty()) {
    const auto test = one_way_anova(one.values, one.factors.front());
    if (!test) return test;
    const auto result = fit_model(one, options);
    add_anova_results(one, result, options, finding, about);
    return test;
  }
  const auto model = fit_nested_model(one.values, one.factors, one.terms, one.groups, 1.0 - options.alpha);
  if (!model) return Estimable<TestResult>::impossible(model.reason());
  const auto& test = model->tests.front().test;
  if (test) add_nested_results(one, *model, options, finding, about);
  return test;
}

// The people of whom every strategy has a value; where all strategies taught other people, all of them.
std::vector<std::size_t> complete_people(const RunTeams& teams, const std::vector<std::size_t>& rows) {
  const auto people = shared_people(teams, rows);
  if (people.empty()) return rows;
  const auto num_strategies = selected(teams.strategy, rows).levels.size();
  const auto& group = people.back();
  std::vector<std::size_t> counts(group.levels.size(), 0), complete;
  for (const auto code : group.codes) ++counts[code];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (counts[group.codes[i]] == num_strategies) complete.push_back(i);
  }
  return complete;
}

}  // namespace

ConveyedAreas read_areas(const RunTeams& teams, const PublishedRun& run) {
  std::unordered_map<std::size_t, std::size_t> position;
  for (std::size_t i = 0; i < teams.size(); ++i) position.emplace(teams.records[i].address.team, i);
  ConveyedAreas areas;
  const std::string table = "tables/periods.csv";
  if (!run.has(table)) return areas;
  std::size_t team = 0, component = 0, n = 0;  // and periods of the component so far
  double sum = 0.0;
  const auto finish = [&] {
    const auto found = position.find(team);
    if (n < 2 || found == position.end() || teams.is_baseline(found->second)) return;
    areas.team.push_back(found->second);
    areas.component.push_back(std::to_string(component));
    areas.mean_log_area.push_back(sum / static_cast<double>(n - 1));
  };
  const auto text = run.read(table);
  read_records<PeriodRecord>({text, (run.folder() / table).string()}, {columns::kComponent, columns::kAreaSr},
                             [&](const RecordRow& row, const PeriodRecord& period) {
                               if (row.address.team != team || period.component != component) {
                                 finish();
                                 team = row.address.team;
                                 component = period.component;
                                 sum = 0.0;
                                 n = 0;
                               }
                               if (++n > 1 && period.area_sr > 0.0) sum += std::log(period.area_sr);
                             });
  finish();
  return areas;
}

std::optional<Finding> demonstrations(const RunTeams& teams, const PublishedRun& run, const AnalysisOptions& options) {
  const auto rows = group_teams(teams);
  const auto model = team_model(teams, rows, columns::kAreaSr, teams.values(outcome_named(columns::kAreaSr)));
  if (selected(teams.strategy, rows).levels.size() < 2) return std::nullopt;
  auto finding = analyze_model(model, options);
  finding.id = "demonstrations";
  finding.topic = "Manipulation check";
  finding.response = "how much the demonstrations convey";
  finding.question = "Do the demonstrations that the strategies choose convey different amounts?";
  finding.sentence = "The smaller the area, the fewer reward weights fit what was shown. " + finding.sentence;
  if (!model.groups.empty()) add_as_published(model, options, finding);
  const auto areas = read_areas(teams, run);
  if (areas.team.empty()) {
    finding.warnings.push_back("periods were not recorded, so components cannot be analysed separately");
    return finding;
  }
  const auto components = make_factor(columns::kComponent, areas.component);
  for (std::size_t level = 0; level < components.levels.size(); ++level) {
    std::vector<std::size_t> part_teams;
    std::vector<double> values;
    for (std::size_t i = 0; i < areas.team.size(); ++i) {
      if (components.codes[i] != level) continue;
      part_teams.push_back(areas.team[i]);
      values.push_back(areas.mean_log_area[i]);
    }
    const auto complete = complete_people(teams, part_teams);
    if (complete.size() < part_teams.size()) {
      finding.warnings.push_back(
          fmt::format("component {}: {} left out whose people were not shown it for two periods under every strategy",
                      components.levels[level], counted(part_teams.size() - complete.size(), "team")));
      part_teams = selected(part_teams, complete);
      values = selected(values, complete);
      if (part_teams.empty()) continue;
    }
    const auto strategy = selected(teams.strategy, part_teams);
    const ModelData one{.response = "log area",
                        .observations = "teams",
                        .values = values,
                        .factors = {strategy},
                        .terms = {{0}},
                        .groups = shared_people(teams, part_teams)};
    const auto about = "Component " + components.levels[level] + ", mean log area without the first period: ";
    const auto test = add_component(one, options, about, finding);
    if (!test) {
      finding.warnings.push_back(fmt::format("component {}: no test: {}", components.levels[level], test.reason()));
      continue;
    }
    finding.sentence += fmt::format(" Component {}: {} ({}); mean log areas range {}.", components.levels[level],
                                    test->p < options.alpha ? "the strategies differ" : "no difference was found",
                                    p_text(test->p), range_of(values, strategy));
  }
  return finding;
}

}  // namespace kith
