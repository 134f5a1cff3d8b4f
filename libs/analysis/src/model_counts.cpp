#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/stats/count_model.hpp"
#include "kith/stats/quasi_poisson.hpp"
#include "kith/stats/survival.hpp"
#include "model_means.hpp"
#include "shown.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

// Tests of terms, and ratios of means with their intervals.
void add_log_linear(const std::string& name, const std::string& detail, const std::vector<TermTest>& terms,
                    const FixedEffects& model, const AnalysisOptions& options, Finding& finding) {
  const bool is_f = !terms.empty() && terms.front().test && terms.front().test->df.size() > 1;
  auto family = tests_of(terms, TestFamily::Residuals::kWhole);
  if (!is_f) family.statistic = TestFamily::Statistic::kChiSquared;
  finding.tables.push_back(shown<TermResult>(
      fmt::format("{} of the {} regression (type II{})", is_f ? "F tests" : "Likelihood-ratio tests", name, detail),
      family.tests,
      {show(&TermResult::subject, "term", Kind::kText), show(&TermResult::df, "df", Kind::kCount),
       show(&TermResult::statistic, is_f ? "F" : "chi-squared"), show(&TermResult::p, "p-value", Kind::kP)}));
  finding.tests.push_back(std::move(family));
  auto plain = options;  // contrasts and equivalence are of differences, which the analysis of variance has
  plain.contrasts.clear();
  plain.by.clear();
  std::vector<ResultTable> tables;
  add_marginal_results(model, plain, false, finding, tables);
  for (auto& table : tables) {
    table.caption = "Ratios of means: " + table.caption;
    finding.tables.push_back(std::move(table));
  }
}

// Counts that vary as Poisson's or less.
void add_quasi_poisson(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  const auto model = fit_quasi_poisson(data.values, data.factors, data.terms);
  if (!model) {
    finding.warnings.push_back("the regression of counts could not be fitted: " + model.reason());
    return;
  }
  add_log_linear("quasi-Poisson", fmt::format(", dispersion {:.2f}", model->dispersion), model->term_tests,
                 model->fixed, options, finding);
  add_method(finding, {"quasi-Poisson regression with F tests", "mccullagh1989"});
}

void add_rates(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  const auto model = fit_count_model(data.values, data.observed, data.factors, data.terms);
  if (!model) {
    finding.warnings.push_back("the regression of counts could not be fitted: " + model.reason());
    return;
  }
  const bool is_censored = model->censored > 0;
  if (!is_censored && !model->theta) return add_quasi_poisson(data, options, finding);
  const std::string family = model->theta ? "negative binomial" : "Poisson";
  add_log_linear((is_censored ? "censored " : "") + family,
                 model->theta ? fmt::format(", theta {:.2f}", *model->theta) : std::string{}, model->term_tests,
                 model->fixed, options, finding);
  add_method(finding,
             {family + " regression" + (is_censored ? " of censored counts" : "") + " with likelihood-ratio tests"});
}

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

void add_count_results(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  if (data.factors.empty() || !data.is_count) return;
  const bool is_mixed = !data.groups.empty();
  const auto cut_off = static_cast<std::size_t>(std::count(data.observed.begin(), data.observed.end(), false));
  if (is_mixed) {
    finding.warnings.push_back(
        "counts are analysed by a linear mixed model, because kith's count regressions have no random intercepts; the "
        "script for R (--r) names one that has");
  } else {
    add_rates(data, options, finding);
  }
  if (cut_off > 0) {
    finding.warnings.push_back(
        fmt::format("{} of {} {} were stopped before they finished, so their counts are lower bounds; the {} takes "
                    "them as they are{}",
                    cut_off, data.values.size(), data.observations, is_mixed ? "mixed model" : "analysis of variance",
                    is_mixed ? "" : ", the regression of counts and the log-rank tests do not"));
  }
  if (data.observed.empty() || (is_mixed && cut_off == 0)) return;
  if (std::all_of(data.values.begin(), data.values.end(), [](double value) { return value > 0.0; }))
    add_survival(data, 1.0 - options.alpha, finding);
}

}  // namespace kith
