#include "model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/effect_size.hpp"

namespace kith {
Estimable<Interval> eta_squared_of(const Estimable<TestResult>& test, double alpha) {
  if (!test) return Estimable<Interval>::impossible(test.reason());
  if (!std::isfinite(test->statistic)) return Estimable<Interval>::impossible("F is beyond the range of numbers");
  auto interval = partial_eta_squared_interval(test->statistic, test->df.at(0), test->df.at(1), 1.0 - 2.0 * alpha);
  // The estimate is too large on average, so that of a small effect can be above the limit.
  interval.high = std::max(interval.high, interval.estimate);
  return interval;
}

Method eta_squared_method(double alpha) {
  return {fmt::format("{:.3g} % intervals of partial eta squared from the non-central F distribution",
                      100.0 * (1.0 - 2.0 * alpha))};
}

std::string formula_text(const ModelData& data) {
  std::string text = data.response + " ~ " + (data.terms.empty() ? "1" : "") +
                     joined(data.terms, " + ", [&](const auto& term) { return term_name(term, data.factors); });
  for (const auto& groups : data.groups) text += " + (1|" + groups.name + ")";
  return text;
}

namespace {

// A model of independent rows; returns why it cannot be fitted, if it cannot.
std::string add_independent_model(const ModelData& data, const AnalysisOptions& options, Finding& finding) {
  const auto result = fit_model(data, options);
  finding.sentence =
      fmt::format("Analysis of variance of {} ({} {}).", data.response, data.values.size(), data.observations);
  if (!result.table.effects) return result.table.effects.reason();
  finding.sentence += sentence_of(data, result, options.alpha);
  finding.warnings = warnings_of(data, result, options.alpha);
  add_anova_results(data, result, options, finding);
  return "";
}

}  // namespace

ModelResult fit_model(const ModelData& data, const AnalysisOptions& options) {
  ModelResult result{anova(data.values, data.factors, data.terms), {}};
  for (const auto& term : result.table.terms) result.eta_squared.push_back(eta_squared_of(term.test, options.alpha));
  return result;
}

Finding analyze_model(const ModelData& data, const AnalysisOptions& options) {
  Finding finding{.id = data.response, .model = formula_text(data)};
  finding.topic = finding.model;
  finding.question = "Does " + data.response + " depend on the factors of the model?";
  const auto reason =
      data.groups.empty() ? add_independent_model(data, options, finding) : add_nested_model(data, options, finding);
  if (!reason.empty()) {
    finding.sentence += " It cannot be fitted, so nothing is tested: " + reason + ".";
    if (auto means = raw_means_table(data, 1.0 - options.alpha, false)) finding.tables.push_back(std::move(*means));
    return finding;
  }
  add_survival_results(data, options, finding);
  add_bound_results(data, options, finding);
  return finding;
}

void add_method(Finding& finding, Method method) {
  const auto same = [&](const Method& known) { return known.text == method.text; };
  if (std::none_of(finding.methods.begin(), finding.methods.end(), same)) finding.methods.push_back(std::move(method));
}

TableCell number_cell(double value) { return TableCell{value}; }
TableCell cell_of(const Estimable<double>& value) {
  if (value) return number_cell(*value);
  return {};
}
TableCell text_cell(std::string text) { return TableCell{std::move(text)}; }
TableCell count_cell(std::size_t count) { return TableCell{static_cast<std::int64_t>(count)}; }

}  // namespace kith
