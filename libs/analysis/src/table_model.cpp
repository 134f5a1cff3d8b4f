#include "kith/analysis/table_model.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "kith/analysis/cell_design.hpp"
#include "kith/analysis/exports.hpp"
#include "kith/core/error.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/csv_writer.hpp"
#include "model_means.hpp"
#include "result_words.hpp"

namespace kith {
namespace {

using RJson = nlohmann::ordered_json;

// "`score` ~ a" as "score".
std::string response_of(const std::string& formula) {
  const auto text = formula.substr(0, formula.find('~'));
  const auto begin = text.find_first_not_of(" `");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" `") + 1 - begin);
}

// As in a plan; nothing for numbers, and if there is no such column, which R says.
std::string_view word_of_response(const Dataset& data, const ModelQuestion& question) {
  auto kind = question.response_kind;
  const auto response = response_of(question.formula);
  if (kind == ColumnKind::kUnspecified && data.has(response)) kind = data.kind(response);
  if (kind == ColumnKind::kOrdinal) return "ordinal";
  return kind == ColumnKind::kCount ? "count" : "";
}

ResultKind kind_named(const std::string& name) {
  for (const auto& known : kWordsFor<ResultKind>) {
    if (known.word == name) return known.value;
  }
  return ResultKind::kNumber;
}

// What does not apply to a row is absent; what cannot be estimated is null.
TableCell cell_read(const RJson& row, const ResultColumn& column) {
  const auto found = row.find(column.field);
  if (found == row.end()) return std::string{};
  if (found->is_string()) return found->get<std::string>();
  if (!found->is_number()) return {};
  if (column.kind == ResultKind::kCount) return static_cast<std::int64_t>(found->get<double>());
  return found->get<double>();
}

ResultTable table_read(const RJson& json) {
  ResultTable table{json.at("caption"), {}, {}};
  for (const auto& column : json.at("columns"))
    table.columns.push_back({column.at("name"), kind_named(column.at("kind")), column.at("field")});
  for (const auto& row : json.at("rows")) {
    auto& cells = table.rows.emplace_back();
    for (const auto& column : table.columns) cells.push_back(cell_read(row, column));
  }
  return table;
}

std::optional<double> number_read(const RJson& row, const char* key) {
  const auto found = row.find(key);
  return found != row.end() && found->is_number() ? std::optional{found->get<double>()} : std::nullopt;
}

// "y ~ a*b" as its names, the response first; nothing for any other formula.
std::vector<std::string> names_of(const std::string& formula) {
  std::vector<std::string> names(1);
  for (const char c : formula) {
    const bool ends = c == (names.size() == 1 ? '~' : '*');
    if (ends) {
      names.emplace_back();
    } else if (std::string_view{"~*+:|()^-/`"}.find(c) != std::string_view::npos) {
      return {};
    } else if (c != ' ') {
      names.back() += c;
    }
  }
  constexpr std::size_t kMostNames = 5;
  const bool any_empty = std::any_of(names.begin(), names.end(), [](const auto& name) { return name.empty(); });
  return names.size() < 2 || names.size() > kMostNames || any_empty ? std::vector<std::string>{} : names;
}

TestFamily tests_read(const RJson& json) {
  TestFamily family{.residuals = TestFamily::Residuals::kFourDigits};
  if (json.at("statistic") != "F") family.statistic = TestFamily::Statistic::kChiSquared;
  for (const auto& row : json.at("tests")) {
    family.tests.push_back({.subject = row.at("subject"),
                            .df = static_cast<std::size_t>(number_read(row, "df").value_or(0.0)),
                            .residual_df = number_read(row, "residual_df"),
                            .statistic = number_read(row, "statistic"),
                            .p = number_read(row, "p")});
  }
  return family;
}

MeanFamily means_read(const RJson& json) {
  MeanFamily family{json.at("factor"), {}};
  for (const auto& row : json.at("means")) {
    family.means.push_back({row.at("level"), number_read(row, "mean"), number_read(row, "low"),
                            number_read(row, "high"), static_cast<std::size_t>(number_read(row, "n").value_or(0.0))});
  }
  return family;
}

Finding finding_read(const RJson& json) {
  Finding finding{.id = json.at("id"),
                  .topic = json.at("title"),
                  .question = json.at("question"),
                  .model = json.at("model"),
                  .sentence = json.at("sentence"),
                  .results = json.at("results"),
                  .warnings = json.at("warnings")};
  if (json.at("tests").is_object()) finding.tests.push_back(tests_read(json.at("tests")));
  for (const auto& means : json.at("means")) finding.means.push_back(means_read(means));
  for (const auto& table : json.at("tables")) finding.tables.push_back(table_read(table));
  for (const auto& method : json.at("methods")) finding.methods.push_back({method.at("text"), method.at("source")});
  return finding;
}

}  // namespace

std::vector<std::string> identifiers_of(const Dataset& data, const std::vector<std::string>& others) {
  std::vector<std::string> found;
  const auto add = [&](const std::string& name) {
    if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
  };
  const auto within = [&](const std::string& outer, const std::string& inner) {
    add(data.has(outer) ? outer + ":" + inner : inner);
  };
  for (const auto& column : data.columns()) {
    if (data.kind(column) != ColumnKind::kIdentifier && column != columns::kSeedAddress) continue;
    if (column == columns::kMember) {
      within(data.has(columns::kTeam) ? columns::kTeam : columns::kSession, column);
    } else if (column == "user_id") {  // of trials
      within("group", column);
    } else if (column == columns::kSeat) {
      within(columns::kSession, column);
    } else {
      add(column);
    }
  }
  for (const auto& name : others) add(name);
  const std::set<std::string> own{columns::kStrategy, columns::kComposition, columns::kReplicate, columns::kTeam};
  const bool is_of_a_study = std::all_of(own.begin(), own.end(), [&](const auto& name) { return data.has(name); });
  if (!is_of_a_study || data.has(columns::kSeedAddress)) return found;
  const auto people = std::string{columns::kComposition} + ":" + columns::kReplicate;
  add(people);
  if (data.has(columns::kMember)) add(people + ":" + columns::kMember);
  return found;
}

std::string table_plan(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options) {
  RJson plan{{"formula", question.formula},
             {"response", word_of_response(data, question)},
             {"observed", question.observed.value_or("")},
             {"identifiers", identifiers_of(data, question.identifiers)},
             {"independent", question.independent},
             {"alpha", options.alpha},
             {"correction", word_for(options.correction)},
             {"by", options.by},
             {"contrasts", RJson::array()}};
  for (const auto& contrast : options.contrasts) {
    RJson weights = RJson::object();
    for (const auto& [level, weight] : contrast.weights) weights[level] = weight;
    plan["contrasts"].push_back({{"name", contrast.name}, {"factor", contrast.factor}, {"weights", weights}});
  }
  if (question.smallest_effect) {
    plan["smallest_effect"] = {{"size", question.smallest_effect->size},
                               {"standardized", question.smallest_effect->standardized}};
  }
  // The formula is as it was typed, in any bytes.
  return plan.dump(2, ' ', false, RJson::error_handler_t::replace) + "\n";
}

std::optional<Analysis> analyze_balanced_table(const Dataset& data, const ModelQuestion& question,
                                               const AnalysisOptions& options) {
  const auto names = names_of(question.formula);
  const bool is_plain = !names.empty() && !question.observed && !question.smallest_effect &&
                        word_of_response(data, question).empty() &&
                        std::all_of(names.begin(), names.end(), [&](const auto& name) { return data.has(name); });
  if (!is_plain) return std::nullopt;
  const auto rows = data.complete(names);
  const auto is_covariate = [&](const std::string& name) { return rows.has_numbers_only(name); };
  if (rows.num_rows() < data.num_rows() || std::any_of(names.begin() + 1, names.end(), is_covariate))
    return std::nullopt;

  ModelData model{.response = names.front()};
  for (std::size_t i = 1; i < names.size(); ++i) model.factors.push_back(rows.factor(names[i]));
  for (std::size_t set = 1; set < std::size_t{1} << model.factors.size(); ++set) {
    std::vector<std::size_t> term;
    for (std::size_t f = 0; f < model.factors.size(); ++f) {
      if ((set >> f & 1U) != 0) term.push_back(f);
    }
    model.terms.push_back(std::move(term));
  }
  std::stable_sort(model.terms.begin(), model.terms.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (const auto& identifier :
       question.independent ? std::vector<std::string>{} : identifiers_of(data, question.identifiers)) {
    const auto outer = identifier.substr(0, identifier.find(':'));
    if (rows.has(outer) && rows.factor(outer).levels.size() < rows.num_rows()) return std::nullopt;
  }
  model.values = rows.required_numbers(names.front());
  check_sizes(rows, names.front());
  check_comparisons(model.factors, options);
  const auto design = make_cell_design(model.values.size(), model.factors, model.terms);
  if (!design || !design->is_balanced()) return std::nullopt;
  auto finding = analyze_model(model, options);
  finding.results = results_paragraph(finding, options.alpha);
  return Analysis{data.file(), {}, {std::move(finding)}, {}};
}

std::string table_csv(const Dataset& data) {
  std::vector<Column> columns;
  for (const auto& name : data.columns()) columns.push_back({.name = name});
  std::string text;
  CsvWriter writer{columns, [&](std::string_view part) { text += part; }};
  for (std::size_t i = 0; i < data.num_rows(); ++i) {
    for (const auto& name : data.columns()) writer.text(data.with_points(name, i).value_or("NA"));
    writer.end_row();
  }
  writer.flush();
  return text;
}

Analysis read_table_findings(std::string_view json, const std::string& subject) {
  const auto refuse = [&](const std::string& message) {
    throw Error{{Diagnostic{.id = "E0904", .message = message, .file = subject, .infeasible = true}}};
  };
  try {
    const auto document = RJson::parse(json);
    if (document.contains("error")) refuse(document.at("error"));
    return {subject, document.at("notes"), {finding_read(document)}, {}};
  } catch (const RJson::exception&) {
    refuse("R printed no result of analysis.R");
  }
  return {};
}

}  // namespace kith
