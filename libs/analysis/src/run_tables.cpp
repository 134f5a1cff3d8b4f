#include "run_tables.hpp"

#include <algorithm>
#include <map>

#include "kith/analysis/moments.hpp"
#include "kith/core/error.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/document.hpp"
#include "kith/study/read_records.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// How many features inputs/domain.toml declares; 0 if it is not there.
std::size_t features_of_domain(const PublishedRun& run) {
  const std::string file = "inputs/domain.toml";
  if (!run.has(file)) return 0;
  const auto parsing = parse_toml(run.read(file), file);
  const auto* value = parsing.document ? parsing.document->root.find("feature") : nullptr;
  return value != nullptr && value->array() != nullptr ? value->array()->size() : 0;
}

}  // namespace

std::vector<double> RunTeams::values(const StudyOutcome& outcome) const {
  std::vector<double> values;
  values.reserve(records.size());
  for (const auto& record : records) values.push_back(outcome.of(record));
  return values;
}

RunTeams read_teams(const PublishedRun& run) {
  const auto file = (run.folder() / "tables" / "teams.csv").string();
  const auto text = run.read("tables/teams.csv");
  const auto keys = varied_keys(text, file);
  RunTeams teams;
  teams.num_features = features_of_domain(run);
  std::vector<std::string> strategies, compositions;
  std::vector<std::vector<std::string>> settings(keys.size());
  std::vector<std::string_view> wanted{columns::kSeedAddress, columns::kStatus};
  for (const auto& outcome : outcomes()) wanted.push_back(outcome.column);
  read_records<TeamRecord>({text, file}, wanted, [&](const RecordRow& row, TeamRecord& record) {
    strategies.push_back(row.address.strategy);
    compositions.push_back(row.address.composition);
    auto& setting = teams.setting.emplace_back();
    for (std::size_t k = 0; k < keys.size(); ++k) {
      settings[k].push_back(row.settings[k]);
      setting += keys[k] + "=" + row.settings[k] + " ";
    }
    teams.records.push_back(std::move(record));
  });
  if (teams.records.empty())
    throw Error{{Diagnostic{.id = "E0906",
                            .message = "the study has no teams",
                            .file = file,
                            .hint = "run the study again",
                            .infeasible = true}}};

  teams.strategy = make_factor(columns::kStrategy, strategies);
  teams.composition = make_factor(columns::kComposition, compositions);
  for (std::size_t k = 0; k < keys.size(); ++k) teams.varied.push_back(make_factor(keys[k], settings[k]));
  return teams;
}

Outcomes outcomes_of(const RunTeams& teams) {
  Outcomes all;
  for (const auto* outcome : analysed_outcomes(teams.has_exam(), exam_leads(teams.has_exam(), teams.num_features)))
    all.emplace_back(outcome->column, teams.values(*outcome));
  return all;
}

std::pair<RunTeams, Outcomes> over_settings(const RunTeams& teams, Outcomes outcomes) {
  if (teams.varied.empty()) return {teams, std::move(outcomes)};
  std::map<std::pair<std::size_t, std::string>, std::vector<std::size_t>> same;  // strategy and people
  for (std::size_t i = 0; i < teams.size(); ++i)
    same[{teams.strategy.codes[i], teams.records[i].seed_address}].push_back(i);
  for (auto& [name, values] : outcomes) {
    const auto all = std::exchange(values, {});
    for (const auto& [who, rows] : same) values.push_back(mean(selected(all, rows)));
  }
  std::vector<std::size_t> first;
  for (const auto& [who, rows] : same) first.push_back(rows.front());
  const std::vector<std::string> none(first.size());
  const auto records = selected(teams.records, first);
  RunTeams over{
      selected(teams.strategy, first), selected(teams.composition, first), {}, none, records, teams.num_features};
  return {std::move(over), std::move(outcomes)};
}

std::vector<std::size_t> group_teams(const RunTeams& teams) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < teams.size(); ++i) {
    if (!teams.is_baseline(i)) rows.push_back(i);
  }
  return rows;
}

Factor selected(const Factor& factor, const std::vector<std::size_t>& rows) {
  return drop_unused({factor.name, factor.levels, selected(factor.codes, rows)});
}

std::vector<Factor> shared_people(const RunTeams& teams, const std::vector<std::size_t>& rows) {
  std::vector<std::string> people, in_setting;
  for (const auto row : rows) {
    people.push_back(teams.records[row].seed_address);
    in_setting.push_back(teams.people(row));
  }
  std::vector<Factor> groups;
  auto all = make_factor("people", people), inner = make_factor("people within settings", in_setting);
  const auto num_people = all.levels.size(), num_inner = inner.levels.size();
  if (num_people < rows.size()) groups.push_back(std::move(all));
  if (num_inner < rows.size() && num_inner > num_people) groups.push_back(std::move(inner));
  return groups;
}

ModelData team_model(const RunTeams& teams, const std::vector<std::size_t>& rows, const std::string& response,
                     const std::vector<double>& values) {
  ModelData data{.response = response, .observations = "teams", .values = selected(values, rows)};
  const auto add = [&](const Factor& factor) {
    auto part = selected(factor, rows);
    if (part.levels.size() < 2) return false;
    data.terms.push_back({data.factors.size()});
    data.factors.push_back(std::move(part));
    return true;
  };
  const bool strategies = add(teams.strategy);
  const bool compositions = add(teams.composition);
  for (const auto& key : teams.varied) add(key);
  if (strategies && compositions) data.terms.push_back({0, 1});
  if (response == columns::kPeriods) {
    for (const auto row : rows) data.observed.push_back(teams.records[row].completed());
  }
  data.groups = shared_people(teams, rows);
  return data;
}

}  // namespace kith
