#include <fmt/format.h>

#include "kith/analysis/clustered_tests.hpp"
#include "kith/analysis/nested_model.hpp"
#include "run_findings.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// Tests of strategy within one composition.
struct WithinTest {
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
  Estimable<TestResult> ranks = Estimable<TestResult>::impossible("not computed");
};

WithinTest test_within(const std::vector<double>& values, const Factor& strategy, const std::vector<Factor>& people) {
  if (people.empty()) return {one_way_anova(values, strategy), kruskal_wallis(values, strategy)};
  const std::vector<std::vector<std::size_t>> terms{{0}};
  const std::vector factors{strategy};
  WithinTest tests;
  const auto model = fit_nested_model(values, factors, terms, people);
  tests.test = model ? model->tests.front().test : Estimable<TestResult>::impossible(model.reason());
  tests.ranks = friedman(values, strategy, people.back());
  return tests;
}

}  // namespace

void add_as_published(const ModelData& model, const AnalysisOptions& options, Finding& finding) {
  finding.warnings.push_back(fmt::format(
      "several strategies taught the same people ({} teams, {} groups of people), so people are a random intercept; "
      "the analysis of variance as published, which takes all teams as independent, misses small differences between "
      "strategies and finds differences between compositions too often",
      model.values.size(), model.groups.front().levels.size()));
  if (model.groups.size() > 1)
    finding.warnings.push_back(
        "this model takes people in another setting as other people, and so finds differences between strategies too "
        "often; other tests of strategies take means over settings");
  const auto table = anova(model.values, model.factors, model.terms);
  auto family = tests_of(table);
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    auto& test = family.tests[t];
    test = with_effect(test, eta_squared_of(table.terms[t].test, options.alpha));
    test.effect = known(table.terms[t].partial_eta_squared);
  }
  finding.tables.push_back(
      anova_table("Analysis of variance as published, all teams taken as independent (type II)", family, table));
  finding.tests.push_back(std::move(family));
}

std::optional<Finding> effects(const RunTeams& teams, const std::string& response, const std::vector<double>& values,
                               const AnalysisOptions& options) {
  const auto model = team_model(teams, group_teams(teams), response, values);
  if (model.terms.empty()) return std::nullopt;
  auto finding = analyze_model(model, options);
  finding.topic =
      "Effect" + std::string{model.factors.size() > 1 ? "s" : ""} + " of " + listed(model.factors, &Factor::name);
  const auto& outcome = outcome_named(response);
  finding.response = outcome.name;
  finding.question = fmt::format("{} {} depend on how a group is taught and who is in it?",
                                 outcome.is_plural ? "Do" : "Does", outcome.name);
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
  const auto label = outcome_named(response).name;
  const auto correction = is_corrected ? name + " correction" : std::string{"no correction"};
  Finding finding{.id = response + "-within-composition",
                  .topic = "Strategy within each composition",
                  .response = std::string{label},
                  .question = fmt::format("Does the strategy affect {} within any single composition?", label),
                  .model = response + " ~ strategy, for each composition separately"};
  const auto people = shared_people(teams, rows);
  const std::string tests = people.empty() ? "One-way analyses of variance" : "Tests within the same people";
  TestFamily family{.residuals = TestFamily::Residuals::kFourDigits, .are_terms = false};
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
    const auto df = test ? static_cast<std::size_t>(test->df.front()) : 0;
    auto& result = family.tests.emplace_back(term_result(compositions.levels[level], df, test));
    if (!test) {
      finding.warnings.push_back(compositions.levels[level] + ": no test: " + test.reason());
      continue;
    }
    result = with_effect(result, eta_squared_of(test, options.alpha));
    result.rank_p = known(ranks, &TestResult::p);
    any_ranks = any_ranks || ranks;
    p_values.push_back(test->p);
    tested.push_back(level);
  }
  const auto corrected = adjust(p_values, options.correction);
  std::string found;
  for (std::size_t i = 0; i < tested.size(); ++i) {
    family.tests[tested[i]].corrected_p = corrected[i];
    if (corrected[i] >= options.alpha) continue;
    found += fmt::format("{}{} ({})", found.empty() ? "" : ", ", compositions.levels[tested[i]], p_text(corrected[i]));
  }
  finding.sentence = fmt::format("{} of {} in {} compositions ({} teams, {}): ", tests, label,
                                 compositions.levels.size(), rows.size(), correction) +
                     (tested.empty()  ? "no composition could be tested."
                      : found.empty() ? "no effect of strategy was found in any of them."
                                      : "strategy has an effect in " + found + ".");
  if (!tested.empty()) {
    add_method(finding,
               {std::string{people.empty() ? "one-way analyses of variance" : "mixed models of each composition"} +
                (is_corrected ? fmt::format(" with {} correction for {}", name, counted(tested.size(), "composition"))
                              : std::string{})});
    add_method(finding, eta_squared_method(options.alpha));
  }
  if (any_ranks)
    add_method(finding, {people.empty() ? "Kruskal-Wallis tests (uncorrected)" : "Friedman tests (uncorrected)"});
  const auto degrees = [residuals = family.residuals](const TermResult& test) {
    return test.statistic ? text_cell(degrees_text(test, residuals)) : TableCell{};
  };
  auto columns = with_effect_columns({show(&TermResult::subject, "composition", Kind::kText),
                                      {{"df", Kind::kText}, degrees},
                                      show(&TermResult::statistic, "F"),
                                      show(&TermResult::p, "p-value", Kind::kP),
                                      show(&TermResult::corrected_p, "corrected p-value", Kind::kP)});
  columns.push_back(
      show(&TermResult::rank_p, people.empty() ? "Kruskal-Wallis p-value" : "Friedman p-value", Kind::kP));
  finding.tables.push_back(shown(tests + " (" + correction + ")", family.tests, columns));
  finding.tests.push_back(std::move(family));
  return finding;
}

}  // namespace kith
