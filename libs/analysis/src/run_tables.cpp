#include "run_tables.hpp"

#include <algorithm>

#include "kith/core/error.hpp"
#include "kith/table/column_names.hpp"
#include "kith/table/csv_reader.hpp"
#include "kith/table/table_text.hpp"
#include "kith/toml/document.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kTeamColumns{columns::kStrategy, columns::kComposition, columns::kReplicate,
                                            columns::kTeam,     columns::kSeedAddress, columns::kCompleted,
                                            columns::kPeriods,  columns::kKnowledge,   columns::kAreaSr};
const std::vector<std::string> kExamColumns{columns::kExamShareRight, columns::kExamRegret,
                                            columns::kExamWorstShareRight};

// The study's varied keys stand between composition and replicate. Where these are missing, or others stand between
// them, that is for the reader of the columns to say.
std::vector<std::string> varied_keys(const std::vector<Column>& columns) {
  const auto named = [](const char* name) { return [name](const Column& column) { return column.name == name; }; };
  const auto begin = std::find_if(columns.begin(), columns.end(), named(columns::kComposition));
  const auto end = std::find_if(begin, columns.end(), named(columns::kReplicate));
  std::vector<std::string> keys;
  if (end == columns.end()) return keys;
  for (auto column = begin + 1; column != end; ++column) {
    const bool is_known = std::find(kTeamColumns.begin(), kTeamColumns.end(), column->name) != kTeamColumns.end();
    if (!is_known) keys.push_back(column->name);
  }
  return keys;
}

std::vector<double> required_numbers(const Dataset& data, const std::string& column) {
  auto values = data.required_numbers(column);
  check_sizes(data, column);
  return values;
}

std::vector<std::string> required_texts(const Dataset& data, const std::string& column) {
  const auto factor = data.factor(column);
  std::vector<std::string> texts;
  texts.reserve(factor.codes.size());
  for (const auto code : factor.codes) texts.push_back(factor.levels[code]);
  return texts;
}

// How many features inputs/domain.toml declares; 0 if it is not there.
std::size_t features_of_domain(const PublishedRun& run) {
  const std::string file = "inputs/domain.toml";
  if (!run.has(file)) return 0;
  const auto parsing = parse_toml(run.read(file), file);
  const auto* value = parsing.document ? parsing.document->root.find("feature") : nullptr;
  return value != nullptr && value->array() != nullptr ? value->array()->size() : 0;
}

}  // namespace

RunTeams read_teams(const PublishedRun& run) {
  const auto file = run.folder() / "tables" / "teams.csv";
  const auto text = run.read("tables/teams.csv");
  const auto header = read_csv_header(text, file.string());
  const auto keys = varied_keys(header);
  const bool has_exam =
      std::any_of(header.begin(), header.end(), [](const Column& one) { return one.name == kExamColumns.front(); });
  const bool has_status =
      std::any_of(header.begin(), header.end(), [](const Column& one) { return one.name == columns::kStatus; });
  auto wanted = kTeamColumns;
  if (has_status) wanted.emplace_back(columns::kStatus);
  wanted.insert(wanted.end(), keys.begin(), keys.end());
  if (has_exam) wanted.insert(wanted.end(), kExamColumns.begin(), kExamColumns.end());
  const auto data = Dataset::parse(text, file.string(), wanted);
  RunTeams teams;
  teams.num_features = features_of_domain(run);
  teams.strategy = data.factor(columns::kStrategy);
  teams.composition = data.factor(columns::kComposition);
  teams.setting.resize(data.num_rows());
  for (const auto& key : keys) {
    teams.varied.push_back(data.factor(key));
    const auto& factor = teams.varied.back();
    for (std::size_t i = 0; i < data.num_rows(); ++i)
      teams.setting[i] += key + "=" + factor.levels[factor.codes[i]] + " ";
  }
  teams.replicate = required_texts(data, columns::kReplicate);
  teams.team = required_texts(data, columns::kTeam);
  teams.seed_address = required_texts(data, columns::kSeedAddress);
  for (const double value : required_numbers(data, columns::kCompleted)) teams.completed.push_back(value != 0.0);
  if (has_status) {
    for (const auto& status : required_texts(data, columns::kStatus)) teams.skipped.push_back(status == "skipped");
  }
  teams.periods = required_numbers(data, columns::kPeriods);
  teams.knowledge = required_numbers(data, columns::kKnowledge);
  teams.area_sr = required_numbers(data, columns::kAreaSr);
  if (has_exam) {
    teams.exam_share_right = required_numbers(data, columns::kExamShareRight);
    teams.exam_regret = required_numbers(data, columns::kExamRegret);
    teams.exam_worst_share_right = required_numbers(data, columns::kExamWorstShareRight);
  }
  if (teams.size() == 0)
    throw Error{{Diagnostic{.id = "E0906",
                            .message = "the study has no teams",
                            .file = file.string(),
                            .hint = "run the study again",
                            .infeasible = true}}};
  return teams;
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
  // A seed address says who is taught. Settings that vary may change what these people are like.
  std::vector<std::string> people, in_setting;
  for (const auto row : rows) {
    people.push_back(teams.seed_address[row]);
    in_setting.push_back(teams.setting[row] + teams.seed_address[row]);
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
  if (response == columns::kPeriods) data.observed = selected(teams.completed, rows);
  data.groups = shared_people(teams, rows);
  return data;
}

}  // namespace kith
