#include "model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kith/analysis/effect_intervals.hpp"

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
  std::string text = data.response + " ~ " + (data.terms.empty() ? "1" : "");
  for (const auto& term : data.terms) {
    if (&term != &data.terms.front()) text += " + ";
    for (const auto factor : term) text += (factor == term.front() ? "" : ":") + data.factors[factor].name;
  }
  for (const auto& groups : data.groups) text += " + (1|" + groups.name + ")";
  return text;
}

ModelResult fit_model(const ModelData& data, const AnalysisOptions& options) {
  ModelResult result{anova(data.values, data.factors, data.terms, SumsOfSquares::kTypeII), {}};
  for (const auto& term : result.table.terms) result.eta_squared.push_back(eta_squared_of(term.test, options.alpha));
  result.linear = fit_linear_model(data.values, data.factors, data.terms);
  return result;
}

Finding analyze_model(const ModelData& data, const AnalysisOptions& options) {
  if (!data.groups.empty()) return analyze_nested_model(data, options);
  const auto result = fit_model(data, options);
  Finding finding;
  finding.id = data.response;
  finding.model = formula_text(data);
  finding.topic = finding.model;
  finding.question = "Does " + data.response + " depend on the factors of the model?";
  finding.sentence = sentence_of(data, result, options.alpha);
  finding.warnings = warnings_of(data, result, options.alpha);
  add_anova_results(data, result, options, finding);
  add_survival_results(data, options, finding);
  add_bound_results(data, options, finding);
  return finding;
}

void add_method(Finding& finding, Method method) {
  const auto same = [&](const Method& known) { return known.text == method.text; };
  if (std::none_of(finding.methods.begin(), finding.methods.end(), same)) finding.methods.push_back(std::move(method));
}

std::string with_and(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

std::string number_and_noun(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

TableCell number_cell(double value) { return TableCell{value}; }
TableCell cell_of(const Estimable<double>& value) {
  if (value) return number_cell(*value);
  return {};
}
TableCell text_cell(std::string text) { return TableCell{std::move(text)}; }
TableCell count_cell(std::size_t count) { return TableCell{static_cast<std::int64_t>(count)}; }

}  // namespace kith
