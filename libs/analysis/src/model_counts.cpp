#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/stats/count_model.hpp"
#include "kith/stats/survival.hpp"
#include "model.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

constexpr double kLittleSpread = 0.9;  // dispersion below which Poisson intervals are misleading

bool are_counts(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return value >= 0.0 && value == std::floor(value); }) &&
         std::any_of(values.begin(), values.end(), [](double value) { return value > 1.0; });
}

std::vector<TableCell> chi_squared_row(const std::string& name, const Estimable<TestResult>& test) {
  return {text_cell(name), cell_of(test, &TestResult::statistic),
          test ? count_cell(static_cast<std::size_t>(test->df.front())) : text_cell(""), cell_of(test, &TestResult::p)};
}

void add_rates(const ModelData& data, double confidence, Finding& finding) {
  const auto model = fit_count_model(data.values, data.factors, confidence);
  if (!model) {
    finding.warnings.push_back("the count regression could not be fitted: " + model.reason());
    return;
  }
  const std::string family = model->theta ? fmt::format("negative binomial, theta {:.2f}", *model->theta) : "Poisson";
  ResultTable table{"Rate ratios (" + family + " regression, main effects)",
                    {{"ratio", Kind::kText},
                     {"estimate", Kind::kFraction},
                     {"lower limit", Kind::kFraction},
                     {"upper limit", Kind::kFraction},
                     {"p-value", Kind::kP}},
                    {}};
  for (const auto& ratio : model->ratios)
    table.rows.push_back(
        {text_cell(ratio.name), ratio.ratio.estimate, ratio.ratio.low, ratio.ratio.high, ratio.test.p});
  ResultTable tests{
      "Likelihood-ratio tests (" + family + " regression)",
      {{"factor", Kind::kText}, {"chi-squared", Kind::kNumber}, {"df", Kind::kCount}, {"p-value", Kind::kP}},
      {}};
  for (std::size_t f = 0; f < data.factors.size(); ++f)
    tests.rows.push_back(chi_squared_row(data.factors[f].name, model->factor_tests[f]));
  add_method(finding,
             {std::string{model->theta ? "negative binomial" : "Poisson"} + " regression with likelihood-ratio tests"});
  if (!model->theta) {
    finding.warnings.push_back(
        model->dispersion < kLittleSpread
            ? fmt::format("counts vary less than Poisson counts (dispersion {:.2f}): intervals of rate ratios are too "
                          "wide and their p-values too large",
                          model->dispersion)
            : fmt::format("counts vary as Poisson counts do (dispersion {:.2f})", model->dispersion));
  }
  finding.tables.push_back(std::move(tests));
  finding.tables.push_back(std::move(table));
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

void add_survival(const ModelData& data, double confidence, Finding& finding) {
  ResultTable curves{
      fmt::format("Median {} (Kaplan-Meier)", data.response),
      {{"group", Kind::kText}, {"n", Kind::kCount}, {"censored", Kind::kCount}, {"median", Kind::kNumber}},
      {}};
  const bool stratified = data.factors.size() > 1;
  ResultTable tests{
      stratified ? "Log-rank tests, stratified by the other factors" : "Log-rank test",
      {{"factor", Kind::kText}, {"chi-squared", Kind::kNumber}, {"df", Kind::kCount}, {"p-value", Kind::kP}},
      {}};
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
    const auto strata = strata_without(data, f);
    const auto test =
        strata ? log_rank(data.values, data.observed, factor, *strata) : log_rank(data.values, data.observed, factor);
    if (!test) finding.warnings.push_back("no log-rank test of " + factor.name + ": " + test.reason());
    any_tested = any_tested || test;
    tests.rows.push_back(chi_squared_row(factor.name, test));
  }
  add_method(finding, {"Kaplan-Meier estimates", "kaplan1958"});
  if (any_tested)
    add_method(finding, {stratified ? "log-rank tests stratified by the other factors" : "the log-rank test"});
  finding.tables.push_back(std::move(tests));
  finding.tables.push_back(std::move(curves));
}

}  // namespace

void add_count_results(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  if (data.factors.empty() || !are_counts(data.values)) return;
  add_rates(data, 1.0 - options.alpha, finding);
  if (data.observed.empty()) return;
  const auto cut_off = static_cast<std::size_t>(std::count(data.observed.begin(), data.observed.end(), false));
  if (cut_off > 0) {
    finding.warnings.push_back(
        fmt::format("{} of {} {} were stopped before they finished, so their counts are lower bounds; only the "
                    "log-rank tests take that into account",
                    cut_off, data.values.size(), data.observations));
  }
  if (std::all_of(data.values.begin(), data.values.end(), [](double value) { return value > 0.0; }))
    add_survival(data, 1.0 - options.alpha, finding);
}

}  // namespace kith
