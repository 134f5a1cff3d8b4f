#include <fmt/format.h>

#include <algorithm>

#include "kith/analysis/survival.hpp"
#include "model.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// All other factors together, as strata.
std::optional<Factor> strata_without(const ModelData& data, std::size_t left_out) {
  std::optional<Factor> strata;
  for (std::size_t f = 0; f < data.factors.size(); ++f) {
    if (f == left_out) continue;
    strata = strata ? interaction(*strata, data.factors[f]) : data.factors[f];
  }
  if (strata) strata = drop_unused(*strata);
  return strata;
}

// Medians that allow for counts that are cut off; with tests if the values are independent.
void add_survival(const ModelData& data, double confidence, Finding& finding) {
  const bool with_tests = data.groups.empty();
  ResultTable curves{
      fmt::format("Median {} (Kaplan-Meier)", data.response),
      {{"group", Kind::kText}, {"n", Kind::kCount}, {"censored", Kind::kCount}, {"median", Kind::kNumber}},
      {}};

  const bool stratified = data.factors.size() > 1;
  TestFamily family{.statistic = TestFamily::Statistic::kChiSquared, .are_terms = false};
  bool any_tested = false;
  for (std::size_t f = 0; f < data.factors.size(); ++f) {
    const auto& factor = data.factors[f];
    for (std::size_t level = 0; level < factor.levels.size(); ++level) {
      std::vector<double> times;
      std::vector<bool> observed;
      for (std::size_t i = 0; i < data.values.size(); ++i) {
        if (factor.codes[i] != level) continue;
        times.push_back(data.values[i]);
        observed.push_back(data.observed[i]);
      }
      const auto curve = kaplan_meier(times, observed, confidence);
      curves.rows.push_back({text_cell(factor.name + " " + factor.levels[level]), count_cell(curve.observations),
                             count_cell(curve.observations - curve.events),
                             curve.median ? TableCell{*curve.median} : text_cell("not reached")});
    }

    if (!with_tests) continue;
    const auto strata = strata_without(data, f);
    const auto test =
        strata ? log_rank(data.values, data.observed, factor, *strata) : log_rank(data.values, data.observed, factor);
    if (!test) finding.warnings.push_back("no log-rank test of " + factor.name + ": " + test.reason());
    any_tested = any_tested || test;
    const auto df = test ? static_cast<std::size_t>(test->df.front()) : 0;
    family.tests.push_back(term_result(factor.name, df, test));
  }

  add_method(finding, {"Kaplan-Meier estimates", "kaplan1958"});
  if (any_tested)
    add_method(finding, {stratified ? "log-rank tests stratified by the other factors" : "the log-rank test"});

  if (with_tests) {
    const auto degrees = [](const TermResult& test) { return test.statistic ? count_cell(test.df) : text_cell(""); };
    finding.tables.push_back(shown<TermResult>(
        stratified ? "Log-rank tests, stratified by the other factors" : "Log-rank test", family.tests,
        {show(&TermResult::subject, "factor", Kind::kText),
         show(&TermResult::statistic, "chi-squared"),
         {{"df", Kind::kCount}, degrees},
         show(&TermResult::p, "p-value", Kind::kP)}));
    finding.tests.push_back(std::move(family));
  }
  finding.tables.push_back(std::move(curves));
}

}  // namespace

void add_survival_results(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  if (data.factors.empty() || data.observed.empty()) return;
  const bool is_nested = !data.groups.empty();
  const auto cut_off = static_cast<std::size_t>(std::count(data.observed.begin(), data.observed.end(), false));
  if (cut_off > 0) {
    finding.warnings.push_back(
        fmt::format("{} of {} {} were stopped before they finished, so their counts are lower bounds; the {} takes "
                    "them as they are{}",
                    cut_off, data.values.size(), data.observations, is_nested ? "mixed model" : "analysis of variance",
                    is_nested ? "" : ", the log-rank tests do not"));
  }
  if (is_nested && cut_off == 0) return;
  if (std::all_of(data.values.begin(), data.values.end(), [](double value) { return value > 0.0; }))
    add_survival(data, 1.0 - options.alpha, finding);
}

}  // namespace kith
