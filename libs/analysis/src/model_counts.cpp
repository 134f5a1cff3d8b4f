#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/stats/count_model.hpp"
#include "kith/stats/survival.hpp"
#include "model.hpp"

namespace kith {
namespace {

using Kind = ResultKind;

constexpr double kLittleSpread = 0.9;  // dispersion below which Poisson intervals mislead

bool are_counts(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return value >= 0.0 && value == std::floor(value); }) &&
         std::any_of(values.begin(), values.end(), [](double value) { return value > 1.0; });
}

void add_rates(const ModelData& data, double confidence, Finding& finding) {
  const auto model = fit_count_model(data.values, data.factors, confidence);
  if (!model) {
    finding.warnings.push_back("count model: not estimable, because " + model.reason());
    return;
  }
  const std::string family = model->theta ? fmt::format("negative binomial, theta {:.2f}", *model->theta) : "Poisson";
  ResultTable table{"Rate ratios (" + family + ", main effects)",
                    {{"ratio", Kind::kText},
                     {"estimate", Kind::kFraction},
                     {"low", Kind::kFraction},
                     {"high", Kind::kFraction},
                     {"p", Kind::kP}},
                    {}};
  for (const auto& ratio : model->ratios)
    table.rows.push_back(
        {text_cell(ratio.name), ratio.ratio.estimate, ratio.ratio.low, ratio.ratio.high, ratio.test.p});
  for (std::size_t f = 0; f < data.factors.size(); ++f) {
    const auto& test = model->factor_tests[f];
    if (test)
      finding.sentence +=
          fmt::format(" As counts ({}): {}, likelihood ratio {}.", family, data.factors[f].name, test_text(*test));
  }
  if (!model->theta) {
    finding.warnings.push_back(
        model->dispersion < kLittleSpread
            ? fmt::format(
                  "counts vary less than Poisson's (dispersion {:.2f}): the intervals of rate ratios are too wide",
                  model->dispersion)
            : fmt::format("counts vary as Poisson's do (dispersion {:.2f})", model->dispersion));
  }
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
      fmt::format("How many {} it takes (Kaplan-Meier)", data.response),
      {{"group", Kind::kText}, {"n", Kind::kCount}, {"cut off", Kind::kCount}, {"median", Kind::kNumber}},
      {}};
  ResultTable tests{"Log-rank tests, within the other factors",
                    {{"factor", Kind::kText}, {"chi-squared", Kind::kNumber}, {"df", Kind::kCount}, {"p", Kind::kP}},
                    {}};
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
    if (!test) finding.warnings.push_back("log-rank, " + factor.name + ": not estimable, because " + test.reason());
    tests.rows.push_back({text_cell(factor.name), cell_of(test, &TestResult::statistic),
                          test ? count_cell(static_cast<std::size_t>(test->df.front())) : text_cell(""),
                          cell_of(test, &TestResult::p)});
    if (test) finding.sentence += fmt::format(" Log-rank for {}: {}.", factor.name, test_text(*test));
  }
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
        fmt::format("{} of {} {} were stopped before they were finished: their counts are lower "
                    "bounds, which only the log-rank tests know",
                    cut_off, data.values.size(), data.observations));
  }
  if (std::all_of(data.values.begin(), data.values.end(), [](double value) { return value > 0.0; }))
    add_survival(data, 1.0 - options.alpha, finding);
}

}  // namespace kith
