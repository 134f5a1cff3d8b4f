#include <fmt/format.h>

#include "run_findings.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

RandomStream stream_of(const AnalysisOptions& options, const std::string& id) {
  return RandomStream{options.seed}.split(id);
}

}  // namespace

std::optional<Finding> effects(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                               const AnalysisOptions& options) {
  const auto model = team_model(teams, group_teams(teams), response, values);
  if (model.terms.empty()) return std::nullopt;
  auto finding = analyze_model(model, options, stream_of(options, response));
  std::vector<std::string> names;
  for (const auto& factor : model.factors) names.push_back(factor.name);
  finding.title = "Effect" + std::string{names.size() > 1 ? "s" : ""} + " of " + with_and(names) + ": " + response;
  finding.question = "Do " + response + " depend on how a group is taught and who is in it?";
  if (response == "knowledge") finding.question.replace(0, 2, "Does");
  return finding;
}

std::optional<Finding> effects_within(const RunTeams& teams, const std::string& response,
                                      const std::vector<double>& values, const AnalysisOptions& options) {
  const auto rows = group_teams(teams);
  const auto compositions = selected(teams.composition, rows);
  if (compositions.levels.size() < 2 || selected(teams.strategy, rows).levels.size() < 2) return std::nullopt;
  const bool is_corrected = options.correction != Correction::kNone;
  const std::string name{to_string(options.correction)};
  const auto correction = is_corrected ? name + " correction" : std::string{"no correction"};
  Finding finding{.id = response + "-within-composition",
                  .title = "Strategy within each composition: " + response,
                  .question = "Does the strategy affect " + response + " within any single composition?",
                  .model = response + " ~ strategy, for each composition separately"};
  ResultTable table{"One-way analyses of variance (" + correction + ")",
                    {{"composition", Kind::kText},
                     {"df", Kind::kText},
                     {"F", Kind::kNumber},
                     {"p-value", Kind::kP},
                     {"corrected p-value", Kind::kP},
                     {"partial eta squared", Kind::kFraction},
                     {"Kruskal-Wallis p-value", Kind::kP}},
                    {}};
  std::vector<double> p_values;
  std::vector<std::size_t> tested;
  bool any_ranks = false;
  for (std::size_t level = 0; level < compositions.levels.size(); ++level) {
    std::vector<std::size_t> part;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (compositions.codes[i] == level) part.push_back(rows[i]);
    }
    const auto group_values = selected(values, part);
    const auto strategy = selected(teams.strategy, part);
    const auto test = one_way_anova(group_values, strategy);
    std::vector<TableCell> row{text_cell(compositions.levels[level])};
    if (test) {
      const double f = test->statistic * test->df[0];
      p_values.push_back(test->p);
      tested.push_back(level);
      const auto ranks = kruskal_wallis(group_values, strategy);
      any_ranks = any_ranks || ranks;
      row.insert(row.end(), {text_cell(fmt::format("{:.0f}, {:.0f}", test->df[0], test->df[1])), test->statistic,
                             test->p, TableCell{}, f / (f + test->df[1]), cell_of(ranks, &TestResult::p)});
    } else {
      row.resize(table.columns.size());
      finding.warnings.push_back(compositions.levels[level] + ": no test: " + test.reason());
    }
    table.rows.push_back(std::move(row));
  }
  const auto corrected = adjust(p_values, options.correction);
  std::string found;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    table.rows[tested[i]][4] = corrected[i];
    if (corrected[i] >= options.alpha) continue;
    found += fmt::format("{}{} ({})", found.empty() ? "" : ", ", compositions.levels[tested[i]], p_text(corrected[i]));
  }
  finding.sentence = fmt::format("One-way analyses of variance of {} within {} compositions ({} teams, {}): ", response,
                                 compositions.levels.size(), rows.size(), correction) +
                     (tested.empty()  ? "no composition could be tested."
                      : found.empty() ? "no effect of strategy was found in any of them."
                                      : "strategy has an effect in " + found + ".");
  if (!tested.empty()) {
    add_method(
        finding,
        {"one-way analyses of variance" +
         (is_corrected ? fmt::format(" with {} correction for {}", name, number_and_noun(tested.size(), "composition"))
                       : std::string{})});
  }
  if (any_ranks) add_method(finding, {"Kruskal-Wallis tests (uncorrected)"});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
