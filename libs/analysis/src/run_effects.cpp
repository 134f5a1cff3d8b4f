#include <fmt/format.h>

#include <map>

#include "run_findings.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

RandomStream stream_of(const AnalysisOptions& options, const std::string& id) {
  return RandomStream{options.seed}.split(id);
}

// Where several strategies taught the same people, their teams are not independent, and a test of the composition has
// to compare people: one mean for each group of them.
void add_between_people(const RunTeams& teams, const std::vector<double>& values, double alpha, Finding& finding) {
  struct People {
    std::size_t composition = 0;
    double sum = 0.0;
    std::size_t teams = 0;
  };
  std::map<std::string, People> people;
  const auto rows = group_teams(teams);
  for (const auto row : rows) {
    auto& one = people[teams.setting[row] + teams.seed_address[row]];
    one.composition = teams.composition.codes[row];
    one.sum += values[row];
    ++one.teams;
  }
  if (people.size() == rows.size()) return;  // everybody was taught once
  std::vector<double> means;
  Factor composition{"composition", teams.composition.levels, {}};
  for (const auto& [address, one] : people) {
    means.push_back(one.sum / static_cast<double>(one.teams));
    composition.codes.push_back(one.composition);
  }
  finding.warnings.push_back(fmt::format(
      "several strategies taught the same people ({} teams of {} groups of people), but the analysis of variance takes "
      "teams as independent: it misses small differences between strategies, for which see the comparison within "
      "people, "
      "and overrates differences between compositions, for which see the test between people",
      rows.size(), people.size()));
  composition = drop_unused(composition);
  if (composition.levels.size() < 2) return;
  const auto test = one_way_anova(means, composition);
  const auto eta_squared = eta_squared_of(test, alpha);
  if (test)
    finding.sentence += fmt::format(" Between {} groups of people, {} of composition was found ({}).", people.size(),
                                    test->p < alpha ? "an effect" : "no effect", p_text(test->p));
  finding.tables.push_back(
      {"Composition, between groups of people (means over strategies)",
       {{"term", Kind::kText},
        {"df", Kind::kText},
        {"F"},
        {"p-value", Kind::kP},
        {"partial eta squared", Kind::kFraction},
        {"lower limit", Kind::kFraction},
        {"upper limit", Kind::kFraction}},
       {{text_cell("composition"), text_cell(test ? fmt::format("{:.0f}, {:.0f}", test->df[0], test->df[1]) : ""),
         cell_of(test, &TestResult::statistic), cell_of(test, &TestResult::p),
         cell_of(eta_squared, &Interval::estimate), cell_of(eta_squared, &Interval::low),
         cell_of(eta_squared, &Interval::high)}}});
  add_method(finding, {"analysis of variance of means over strategies between groups of people"});
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
  add_between_people(teams, values, options.alpha, finding);
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
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
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
      const auto eta_squared = eta_squared_of(test, options.alpha);
      p_values.push_back(test->p);
      tested.push_back(level);
      const auto ranks = kruskal_wallis(group_values, strategy);
      any_ranks = any_ranks || ranks;
      row.insert(row.end(),
                 {text_cell(fmt::format("{:.0f}, {:.0f}", test->df[0], test->df[1])), test->statistic, test->p,
                  TableCell{}, cell_of(eta_squared, &Interval::estimate), cell_of(eta_squared, &Interval::low),
                  cell_of(eta_squared, &Interval::high), cell_of(ranks, &TestResult::p)});
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
  if (!tested.empty()) add_method(finding, eta_squared_method(options.alpha));
  if (any_ranks) add_method(finding, {"Kruskal-Wallis tests (uncorrected)"});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
