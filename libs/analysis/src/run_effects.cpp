#include <fmt/format.h>

#include <cmath>

#include "kith/stats/clustered_tests.hpp"
#include "kith/stats/mixed_model.hpp"
#include "outcomes.hpp"
#include "run_findings.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

RandomStream stream_of(const AnalysisOptions& options, const std::string& id) {
  return RandomStream{options.seed}.split(id);
}

// Tests of strategy within one composition.
struct WithinTest {
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
  Estimable<TestResult> ranks = Estimable<TestResult>::impossible("not computed");
};

WithinTest test_within(const std::vector<double>& values, const Factor& strategy, const std::vector<Factor>& people) {
  if (people.empty()) return {one_way_anova(values, strategy), kruskal_wallis(values, strategy)};
  MixedModelOptions fit;
  fit.test_variances = false;
  const std::vector<std::vector<std::size_t>> terms{{0}};
  const std::vector factors{strategy};
  WithinTest tests;
  const auto model = fit_mixed_model(values, factors, terms, people, fit);
  tests.test = model ? term_tests(model->fixed, SumsOfSquares::kTypeII).front().test
                     : Estimable<TestResult>::impossible(model.reason());
  tests.ranks = friedman(values, strategy, people.back());
  return tests;
}

std::string degrees_text(const TestResult& test) {
  return std::isinf(test.df[1]) ? fmt::format("{:.0f}, inf", test.df[0])
                                : fmt::format("{:.0f}, {:.4g}", test.df[0], test.df[1]);
}

}  // namespace

void add_as_published(const ModelData& model, const AnalysisOptions& options, Finding& finding) {
  finding.warnings.push_back(fmt::format(
      "several strategies taught the same people ({} teams, {} groups of people), so people are a random intercept; "
      "the "
      "analysis of variance as published, which takes all teams as independent, misses small differences between "
      "strategies and finds differences between compositions too often",
      model.values.size(), model.groups.front().levels.size()));
  const auto table = anova(model.values, model.factors, model.terms, SumsOfSquares::kTypeII);
  ResultTable result{"Analysis of variance as published, all teams taken as independent (type II)",
                     {{"term", Kind::kText},
                      {"df", Kind::kCount},
                      {"sum of squares"},
                      {"F"},
                      {"p-value", Kind::kP},
                      {"partial eta squared", Kind::kFraction},
                      {"lower limit", Kind::kFraction},
                      {"upper limit", Kind::kFraction}},
                     {}};
  for (const auto& term : table.terms) {
    const auto eta_squared = eta_squared_of(term.test, options.alpha);
    result.rows.push_back({text_cell(term.name), count_cell(term.df), term.sum_of_squares,
                           cell_of(term.test, &TestResult::statistic), cell_of(term.test, &TestResult::p),
                           cell_of(term.partial_eta_squared), cell_of(eta_squared, &Interval::low),
                           cell_of(eta_squared, &Interval::high)});
  }
  std::vector<TableCell> residuals(result.columns.size(), text_cell(""));
  residuals[0] = text_cell("residuals");
  residuals[1] = count_cell(table.residual_df);
  residuals[2] = table.residual_sum_of_squares;
  result.rows.push_back(std::move(residuals));
  finding.tables.push_back(std::move(result));
}

std::optional<Finding> effects(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                               const AnalysisOptions& options) {
  const auto model = team_model(teams, group_teams(teams), response, values);
  if (model.terms.empty()) return std::nullopt;
  auto finding = analyze_model(model, options, stream_of(options, response));
  std::vector<std::string> names;
  for (const auto& factor : model.factors) names.push_back(factor.name);
  finding.title = "Effect" + std::string{names.size() > 1 ? "s" : ""} + " of " + with_and(names) + ": ";
  const auto words = outcome_words(response);
  finding.title += words.label;
  finding.question = fmt::format("{} {} depend on how a group is taught and who is in it?",
                                 words.is_plural ? "Do" : "Does", words.label);
  if (!model.groups.empty()) add_as_published(model, options, finding);
  return finding;
}

std::optional<Finding> effects_within(const RunTeams& teams, const std::string& response,
                                      const std::vector<double>& values, const AnalysisOptions& options) {
  const auto rows = group_teams(teams);
  const auto compositions = selected(teams.composition, rows);
  if (compositions.levels.size() < 2 || selected(teams.strategy, rows).levels.size() < 2) return std::nullopt;
  const bool is_corrected = options.correction != Correction::kNone;
  const std::string name{to_string(options.correction)};
  const auto label = outcome_words(response).label;
  const auto correction = is_corrected ? name + " correction" : std::string{"no correction"};
  Finding finding{.id = response + "-within-composition",
                  .title = fmt::format("Strategy within each composition: {}", label),
                  .question = fmt::format("Does the strategy affect {} within any single composition?", label),
                  .model = response + " ~ strategy, for each composition separately"};
  const auto people = shared_people(teams, rows);
  const std::string tests = people.empty() ? "One-way analyses of variance" : "Tests within the same people";
  ResultTable table{tests + " (" + correction + ")",
                    {{"composition", Kind::kText},
                     {"df", Kind::kText},
                     {"F", Kind::kNumber},
                     {"p-value", Kind::kP},
                     {"corrected p-value", Kind::kP},
                     {"partial eta squared", Kind::kFraction},
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
                     {people.empty() ? "Kruskal-Wallis p-value" : "Friedman p-value", Kind::kP}},
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
    const auto [test, ranks] = test_within(group_values, strategy, shared_people(teams, part));
    std::vector<TableCell> row{text_cell(compositions.levels[level])};
    if (test) {
      const auto eta_squared = eta_squared_of(test, options.alpha);
      p_values.push_back(test->p);
      tested.push_back(level);
      any_ranks = any_ranks || ranks;
      row.insert(row.end(), {text_cell(degrees_text(*test)), test->statistic, test->p, TableCell{},
                             cell_of(eta_squared, &Interval::estimate), cell_of(eta_squared, &Interval::low),
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
  finding.sentence = fmt::format("{} of {} in {} compositions ({} teams, {}): ", tests, label,
                                 compositions.levels.size(), rows.size(), correction) +
                     (tested.empty()  ? "no composition could be tested."
                      : found.empty() ? "no effect of strategy was found in any of them."
                                      : "strategy has an effect in " + found + ".");
  if (!tested.empty()) {
    add_method(
        finding,
        {std::string{people.empty() ? "one-way analyses of variance" : "mixed models of each composition"} +
         (is_corrected ? fmt::format(" with {} correction for {}", name, number_and_noun(tested.size(), "composition"))
                       : std::string{})});
  }
  if (!tested.empty()) add_method(finding, eta_squared_method(options.alpha));
  if (any_ranks)
    add_method(finding, {people.empty() ? "Kruskal-Wallis tests (uncorrected)" : "Friedman tests (uncorrected)"});
  finding.tables.push_back(std::move(table));
  return finding;
}

}  // namespace kith
