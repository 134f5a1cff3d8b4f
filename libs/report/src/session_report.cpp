#include "sections.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "first_screen.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/table_model.hpp"
#include "kith/core/text.hpp"
#include "kith/files/column_names.hpp"
#include "outcomes.hpp"
#include "sentences.hpp"
#include "session_tables.hpp"
#include "team_tables.hpp"

namespace kith::detail {
namespace {

std::string percent_of(std::size_t part, std::size_t whole) {
  return std::to_string((200 * part + whole) / (2 * whole)) + " %";
}

bool is_enough(std::size_t reached, std::size_t people) {
  constexpr std::size_t kFew = 10;
  return reached >= kFew || 5 * reached >= people;
}

// "item-delivery" of study.json.
std::string about(const SessionTables& tables, const char* key) {
  const auto found = tables.about.find(key);
  return found != tables.about.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

std::string program_of(const SessionTables& tables) {
  const auto program = about(tables, "program");
  return program.rfind("kith", 0) == 0 ? program : "kith " + program;
}

ReportDesign design_of(const SessionTables& tables) {
  ReportDesign design;
  for (const auto& group : tables.groups) {
    const bool same_series = !design.series.empty() && design.series.back().strategy == group.strategy;
    if (!same_series) design.series.push_back({group.strategy, label_of(group.strategy), group.strategy, 0, {}});
    const bool same_cell = same_series && design.cells.back().composition == group.composition;
    if (!same_cell) design.cells.push_back({design.series.size() - 1, group.composition, 0});
    ++design.cells.back().teams;
    design.cell_of_team.push_back(design.cells.size() - 1);
    for (const char letter : group.composition) ++design.series.back().people[letter];
    design.people += group.people;
  }
  return design;
}

RunData data_of(const SessionTables& tables) {
  RunData data;
  for (const auto& group : tables.groups) {
    auto& team = data.teams.emplace_back();
    team.address.replicate = group.replicate;
    team.status = group.completed ? SessionStatus::kComplete : SessionStatus::kMaxPeriods;
    team.periods = group.periods;
    team.cost.person_periods = group.periods * group.people;
    team.knowledge = group.knowledge.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  return data;
}

// Without the columns whose names begin like this.
Json without_columns(Json table, const std::string& prefix) {
  Json columns = Json::array();
  std::vector<bool> is_kept;
  for (const auto& column : table["columns"]) {
    is_kept.push_back(column.get<std::string>().rfind(prefix, 0) != 0);
    if (is_kept.back()) columns.push_back(column);
  }
  for (auto& row : table["rows"]) {
    Json kept = Json::array();
    for (std::size_t i = 0; i < is_kept.size(); ++i) {
      if (is_kept[i]) kept.push_back(row[i]);
    }
    row = std::move(kept);
  }
  table["columns"] = std::move(columns);
  return table;
}

// What is told of people from period to period. Members whose place a simulated learner had are left out.
class PeopleTables {
 public:
  PeopleTables(const SessionTables& tables, const ReportDesign& design) : tables_{tables}, design_{design} {
    const auto& people = tables.participants;
    const auto member = people.numbers(columns::kMember), simulated = people.numbers(columns::kSimulated);
    for (std::size_t i = 0; i < people.num_rows(); ++i) {
      if (!member[i] || simulated[i].value_or(0.0) == 0.0) continue;
      simulated_.insert({people.cells(columns::kSession)[i].value_or(""), static_cast<std::size_t>(*member[i])});
    }
  }

  [[nodiscard]] std::size_t num_simulated() const { return simulated_.size(); }

  // The teacher's estimate of what each member knows.
  [[nodiscard]] Json knowledge() const {
    const auto& rows = tables_.beliefs;
    const auto member = rows.numbers(columns::kMember), period = rows.numbers(columns::kPeriod),
               mass = rows.numbers(columns::kBelief);
    std::map<Key, std::vector<double>> values;
    for (std::size_t i = 0; i < rows.num_rows(); ++i) {
      if (!member[i] || !mass[i]) continue;
      const auto key = key_of(rows.cells(columns::kSession)[i].value_or(""), *member[i], period[i].value_or(0.0));
      if (key) values[*key].push_back(*mass[i]);
    }
    JsonTable table{{"strategy", "type", "period", "mean", "low", "high", "people"}};
    for (const auto& [key, masses] : values) {
      if (!is_enough(masses.size(), people_of(key))) continue;
      auto row = row_of(key);
      add_interval(row, masses);
      row.push_back(masses.size());
      table.add(std::move(row));
    }
    return std::move(table).take();
  }

  [[nodiscard]] Json right_answers() const {
    struct Count {
      std::set<std::string> people;
      std::size_t answers = 0, right = 0;
    };
    const auto& rows = tables_.tests;
    const auto member = rows.numbers(columns::kMember), period = rows.numbers(columns::kPeriod),
               correct = rows.numbers(columns::kCorrect);

    std::map<Key, Count> counts;
    for (std::size_t i = 0; i < rows.num_rows(); ++i) {
      const auto session = rows.cells(columns::kSession)[i].value_or("");
      const auto key = correct[i] && member[i] ? key_of(session, *member[i], period[i].value_or(0.0)) : std::nullopt;
      if (!key) continue;
      auto& count = counts[*key];
      count.people.insert(session + "/" + rows.cells(columns::kSeat)[i].value_or(""));
      ++count.answers;
      count.right += *correct[i] != 0.0 ? 1u : 0u;
    }

    // Too few people are no curve.
    JsonTable table{{"strategy", "type", "period", "share", "low", "high", "answers"}};
    for (const auto& [key, count] : counts) {
      if (!is_enough(count.people.size(), people_of(key))) continue;
      const auto share = wilson_interval(count.right, count.answers);
      auto row = row_of(key);
      for (const double value : {share.estimate, share.low, share.high}) row.push_back(number(value));
      row.push_back(count.answers);
      table.add(std::move(row));
    }
    return std::move(table).take();
  }

 private:
  using Key = std::tuple<std::size_t, char, std::size_t>;  // series, type, period

  [[nodiscard]] std::optional<Key> key_of(const std::string& session, double member, double period) const {
    const auto group = tables_.group_of(session);
    const auto place = static_cast<std::size_t>(member);
    if (!group || place == 0 || place > tables_.groups[*group].composition.size()) return std::nullopt;
    if (simulated_.count({session, place}) != 0) return std::nullopt;
    return Key{design_.cells[design_.cell_of_team[*group]].series, tables_.groups[*group].composition[place - 1],
               static_cast<std::size_t>(period)};
  }
  [[nodiscard]] std::size_t people_of(const Key& key) const {
    const auto& people = design_.series[std::get<0>(key)].people;
    const auto found = people.find(std::get<1>(key));
    return found == people.end() ? 0 : found->second;
  }
  [[nodiscard]] Json row_of(const Key& key) const {
    return Json::array({design_.series[std::get<0>(key)].code, std::string{std::get<1>(key)}, std::get<2>(key)});
  }

  const SessionTables& tables_;
  const ReportDesign& design_;
  std::set<std::pair<std::string, std::size_t>> simulated_;
};

// How many periods each component took.
Json component_periods(const SessionTables& tables, const ReportDesign& design) {
  const auto component = tables.periods.numbers(columns::kTaughtComponent),
             active = tables.periods.numbers(columns::kActive);
  std::map<std::pair<std::size_t, std::size_t>, double> periods;  // by group and component
  std::size_t num_components = 0;
  for (std::size_t i = 0; i < tables.periods.num_rows(); ++i) {
    const auto group = tables.group_of(tables.periods.cells(columns::kSession)[i].value_or(""));
    if (!group || !component[i] || !active[i]) continue;  // not finished
    const auto number = static_cast<std::size_t>(*component[i]);
    num_components = std::max(num_components, number);
    ++periods[{*group, number}];
  }
  JsonTable table{{"strategy", "composition", "kc", "mean_periods", "low", "high"}};
  for (std::size_t kc = 1; kc <= num_components; ++kc) {
    std::vector<std::vector<double>> values(design.cells.size());
    for (std::size_t group = 0; group < tables.groups.size(); ++group) {
      const auto found = periods.find({group, kc});
      if (found != periods.end()) values[design.cell_of_team[group]].push_back(found->second);
    }
    for (std::size_t cell = 0; cell < design.cells.size(); ++cell) {
      if (values[cell].empty()) continue;
      auto row = Json::array({design.series[design.cells[cell].series].code, design.cells[cell].composition, kc});
      add_interval(row, values[cell]);
      table.add(std::move(row));
    }
  }
  return std::move(table).take();
}

Json groups_table(const SessionTables& tables, std::size_t points) {
  JsonTable table{{"strategy", "composition", "replicate", "team", "periods", "knowledge", "completed"}};
  for (const auto& group : tables.groups) {
    if (group.replicate > points) continue;
    table.add(Json::array({group.strategy, group.composition, group.replicate, group.session, group.periods,
                           number(group.knowledge), group.completed}));
  }
  return std::move(table).take();
}

Json labels_of(const SessionTables& tables, const ReportDesign& design) {
  Json strategies = Json::object(), types = Json::object();
  std::map<char, std::string> names;
  for (const auto& series : design.series) strategies[series.code] = series.label;
  if (const auto found = tables.about.find("types"); found != tables.about.end() && found->is_array()) {
    for (const auto& type : *found) {
      const auto letter = type.value("letter", "");
      const auto label = type.value("label", "");
      types[letter] = label.empty() ? letter : label;
      if (!letter.empty()) names[letter.front()] = label;
    }
  }

  const Json columns{{"type", "Type of the place"},
                     {"kc", "Component"},
                     {"teams", "Groups"},
                     {"team", "Group"},
                     {"knowledge", "Estimated knowledge"},
                     {"knowledge_mean", "Estimated knowledge, mean"},
                     {"knowledge_sd", "Estimated knowledge, sd"},
                     {"knowledge_low", "Estimated knowledge, 95 % low"},
                     {"knowledge_high", "Estimated knowledge, 95 % high"},
                     {"mean_periods", "Periods, mean"},
                     {"at_risk", "At risk"},
                     {"low", "95 % low"},
                     {"high", "95 % high"}};

  const std::string estimate =
      "By their answers, as kith audit judges them: how often a member is expected to predict all of a component "
      "rightly, as a mean over the components taught. ";
  const std::string belief =
      "The share of the teacher's belief about a member that lies in the policy's region (BEC). ";
  const Json figures{
      {"knowledge",
       {{"title", "Estimated knowledge at the end by strategy and composition"},
        {"reading", estimate + "Large marks are means with 95 % intervals, small dots are individual groups."}}},
      {"knowledge-periods",
       {{"title", "The teacher's belief over periods by type of place"},
        {"reading", belief + "Means with 95 % bands. Lines end where too few people are still being taught."}}},
      {"correct-periods",
       {{"title", "Right answers over periods by type of place"},
        {"reading",
         "Share of people's answers that were right, with 95 % bands; later periods include only the groups that "
         "needed longest."}}}};
  return {{"strategies", std::move(strategies)},
          {"types", std::move(types)},
          {"meanings", meanings(design, names)},
          {"columns", columns},
          {"figures", figures}};
}

struct AnswerCounts {
  std::size_t answers = 0;
  std::size_t right = 0;
};

// Of people, in finished periods.
AnswerCounts count_answers(const SessionTables& tables) {
  const auto& people = tables.participants;
  const auto simulated = people.numbers(columns::kSimulated), tests = people.numbers(columns::kTests),
             right = people.numbers(columns::kRight);
  AnswerCounts counts;
  for (std::size_t i = 0; i < people.num_rows(); ++i) {
    if (simulated[i].value_or(0.0) != 0.0) continue;
    counts.answers += static_cast<std::size_t>(tests[i].value_or(0.0));
    counts.right += static_cast<std::size_t>(right[i].value_or(0.0));
  }
  return counts;
}

std::size_t num_completed(const SessionTables& tables) {
  return static_cast<std::size_t>(std::count_if(tables.groups.begin(), tables.groups.end(),
                                                [](const LiveGroup& group) { return group.completed; }));
}

Json summary_of(const SessionTables& tables, std::size_t people) {
  Json sentences = Json::array();
  const auto groups = tables.groups.size();
  sentences.push_back(how_many(groups, "group", "groups") + " with " + how_many(people, "person", "people") +
                      " in all " + (groups == 1 ? "was" : "were") + " taught how a robot decides, in live sessions.");
  if (groups == 0) return sentences;
  const auto counts = count_answers(tables);
  if (counts.answers > 0) {
    sentences.push_back(percent_of(counts.right, counts.answers) + " of " +
                        how_many(counts.answers, "answer was right.", "answers were right."));
  }
  return sentences;
}

std::vector<std::string> notes_of(const SessionTables& tables, const PeopleTables& people) {
  std::vector<std::string> notes;
  if (tables.num_waiting > 0) {
    notes.push_back(how_many(tables.num_waiting, "room was", "rooms were") + " never taught and " +
                    (tables.num_waiting == 1 ? "is" : "are") + " left out.");
  }

  std::map<std::string, std::size_t> reasons;
  for (const auto& group : tables.groups) {
    if (!group.ended.empty()) ++reasons[group.ended];
  }
  const auto counts =
      joined(reasons, ", ", [](const auto& one) { return one.first + ": " + std::to_string(one.second); });

  const auto censored = tables.groups.size() - num_completed(tables);
  if (censored > 0) {
    notes.push_back(how_many(censored, "group", "groups") + " stopped before everything was learned" +
                    (counts.empty() ? "" : " (" + counts + ")") +
                    ". The completion curves treat them as censored; means include them with the periods they had.");
  }

  if (people.num_simulated() > 0) {
    notes.push_back("Simulated learners had the places of " + how_many(people.num_simulated(), "member", "members") +
                    ". Curves over periods leave those places out; knowledge at the end includes them.");
  }
  return notes;
}

std::size_t num_levels(const SessionTables& tables, std::string LiveGroup::*factor) {
  std::set<std::string> levels;
  for (const auto& group : tables.groups) levels.insert(group.*factor);
  return levels.size();
}

// Periods and estimated knowledge by what distinguishes the groups. A design in which nothing can be compared has no
// findings, and that is no error.
std::vector<Finding> findings_of(const SessionTables& tables, const ReportOptions& options,
                                 std::vector<std::string>& notes) {
  std::string factors;
  if (num_levels(tables, &LiveGroup::strategy) > 1) factors = "strategy";
  if (num_levels(tables, &LiveGroup::composition) > 1) factors += factors.empty() ? "composition" : "*composition";

  std::vector<Finding> findings;
  if (factors.empty()) {
    notes.emplace_back("Nothing was tested: all groups were taught alike.");
    return findings;
  }

  // Groups that have begun.
  const std::vector<std::string> needed{"started_ms"};
  const auto taught = tables.sessions.complete(needed);
  for (const std::string response : {"periods", "knowledge"}) {
    try {
      ModelQuestion question;
      question.formula = response + " ~ " + factors;
      if (response == "periods") {
        question.observed = "completed";
        question.response_kind = ColumnKind::kCount;
      }
      auto analysis =
          options.test_model ? options.test_model(taught, question) : analyze_balanced_table(taught, question, {});
      if (analysis) {
        std::move(analysis->findings.begin(), analysis->findings.end(), std::back_inserter(findings));
      } else {
        notes.push_back("'" + question.formula +
                        "' was not tested, which needs R: kith analyze tables/sessions.csv "
                        "--model '" +
                        question.formula + "'.");
      }
    } catch (const Error& error) {
      notes.push_back("'" + response + " ~ " + factors + "' was not tested: " +
                      (error.diagnostics().empty() ? std::string{error.what()} : error.diagnostics().front().message) +
                      ".");
    }
  }
  return findings;
}

Json methods_of(const SessionTables& tables, const ReportDesign& design) {
  std::string text = how_many(tables.groups.size(), "group", "groups") + " of people (" +
                     how_many(design.people, "person", "people") +
                     ") were taught the policy of a robot in the domain " + about(tables, "domain") +
                     " in their browsers, with " + program_of(tables) + ".";
  if (design.series.size() > 1 || design.cells.size() > 1) {
    text += " Groups were assigned in turn to " + how_many(design.cells.size(), "combination", "combinations") +
            " of strategy and composition.";
  }
  text +=
      " An answer counts as right if its return under the robot's reward equals that of the robot's path. Knowledge is "
      "estimated from all answers of a member: how often the member is expected to predict all of a component rightly, "
      "averaged over the components that were taught and over members.";
  return {{"paragraph", text}, {"references", Json::array()}};
}

Json reproduction_of(const SessionTables& tables) {
  Json hashes = Json::object();
  for (const auto& [name, hash] : tables.hashes) hashes[name] = hash;
  Json about_run{{"command", "kith session export SESSION -o DIR"},
                 {"version", program_of(tables)},
                 {"hashes", std::move(hashes)}};
  const auto inputs = tables.about.find("inputs");
  if (inputs == tables.about.end() || !inputs->is_object()) return about_run;
  if (inputs->contains("study.toml")) about_run["study_toml"] = (*inputs)["study.toml"];
  if (inputs->contains("domain.toml")) about_run["domain_toml"] = (*inputs)["domain.toml"];
  return about_run;
}

}  // namespace

Json session_report(const std::filesystem::path& folder, const ReportOptions& options) {
  const auto step = [&](std::string_view text) {
    if (options.on_step) options.on_step(text);
  };

  step("reading the tables");
  const auto tables = read_session_tables(folder);
  const auto design = design_of(tables);
  const auto data = data_of(tables);
  const PeopleTables people{tables, design};
  auto notes = notes_of(tables, people);

  step("analysing");
  const auto findings = findings_of(tables, options, notes);
  const FirstScreen screen{.design = design, .data = data, .findings = findings, .simulated = false};

  Json strategies = Json::array();
  for (const auto& series : design.series) strategies.push_back(series.code);
  std::vector<std::string> compositions;
  for (const auto& cell : design.cells) {
    if (std::find(compositions.begin(), compositions.end(), cell.composition) == compositions.end())
      compositions.push_back(cell.composition);
  }

  Json shown{{"cells", without_columns(cells_table(design, data), "area")},
             {"teams", groups_table(tables, options.points_per_cell)},
             {"completion", completion_table(design, data)},
             {"knowledge_by_period", people.knowledge()},
             {"correct_by_period", people.right_answers()},
             {"periods_by_component", component_periods(tables, design)}};
  const auto title = about(tables, "title");
  Json overview{{"simulated", false},
                {"teams", tables.groups.size()},
                {"people", design.people},
                {"completed", num_completed(tables)},
                {"strategies", std::move(strategies)},
                {"compositions", compositions},
                {"factors", Json::array()},
                {"summary", summary_of(tables, design.people)}};

  if (!tables.groups.empty()) {
    overview["fixed_periods"] = has_fixed_periods(screen);
    overview["finding"] = headline(screen);
    overview["answers"] = answers(screen);
    overview["limits"] = limits(screen);
    if (auto figure = differences(screen); !figure.is_null()) overview["differences"] = std::move(figure);
  }

  return {{"schema", "kith.report/1"},
          {"title", title.empty() ? about(tables, "study") : title},
          {"study", about(tables, "study")},
          {"domain", about(tables, "domain")},
          {"labels", labels_of(tables, design)},
          {"overview", std::move(overview)},
          {"outcomes", outcomes_json(false)},
          {"notes", notes},
          {"tables", std::move(shown)},
          {"findings", Json::parse(findings_json({.subject = {}, .notes = {}, .findings = findings}))},
          {"methods", methods_of(tables, design)},
          {"reproduce", reproduction_of(tables)}};
}

}  // namespace kith::detail
