#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/factor.hpp"
#include "kith/analysis/finding.hpp"
#include "kith/analysis/nested_model.hpp"
#include "kith/core/text.hpp"

namespace kith {

// One response and the factors that may explain it.
struct ModelData {
  std::string response{};             // its name
  std::string observations = "rows";  // what one value is, in the plural
  std::vector<double> values{};
  std::vector<Factor> factors{};                  // used by some term each
  std::vector<std::vector<std::size_t>> terms{};  // sets of indices of factors
  std::vector<bool> observed{};                   // false: a count that was cut off; empty: nothing is cut off
  std::vector<Factor> groups{};                   // of random intercepts, nested; empty: the values are independent
};

// The analysis of variance of a model with its intervals.
struct ModelResult {
  AnovaTable table;
  std::vector<Estimable<Interval>> eta_squared;  // per term, with confidence 1 - 2 alpha
};
[[nodiscard]] ModelResult fit_model(const ModelData& data, const AnalysisOptions& options);

// "periods ~ strategy + composition"
[[nodiscard]] std::string formula_text(const ModelData& data);

// Every term in words: what was found about it.
[[nodiscard]] std::string sentence_of(const ModelData& data, const ModelResult& result, double alpha);
// One of them, with the sizes that the interval of partial eta squared spans, and the range of the marginal means.
[[nodiscard]] std::string term_sentence(const ModelData& data, std::size_t term, const Estimable<TestResult>& test,
                                        const Estimable<Interval>& eta_squared, const FixedEffects& means,
                                        double alpha);
// What is doubtful about the model, and what could not be estimated.
[[nodiscard]] std::vector<std::string> warnings_of(const ModelData& data, const ModelResult& result, double alpha);

// Adds tables of the analysis of variance, of means and of pairs of levels, and the methods behind them.
// Captions begin with `about`.
void add_anova_results(const ModelData& data, const ModelResult& result, const AnalysisOptions& options,
                       Finding& finding, const std::string& about = "");

// Counts of which some may be cut off (data.observed): medians, and log-rank tests unless rows belong together, because
// these assume independent rows.
void add_survival_results(const ModelData& data, const AnalysisOptions& options, Finding& finding);

// Values of an outcome with a range (StudyOutcome) that are at one of its ends: a note, the shares of values that are
// exactly there (Wilson), and, of rows that belong together, tests of the same model on ranks; those of independent
// rows are in the finding already.
void add_bound_results(const ModelData& data, const AnalysisOptions& options, Finding& finding);

// The raw means of every combination of levels; missing if there are too many. Without limits: rows that belong
// together allow none.
[[nodiscard]] std::optional<ResultTable> raw_means_table(const ModelData& data, double confidence, bool with_limits);

// Adds a model with data.groups as random intercepts to a finding: sentences, tests, variances, means and pairs.
// Returns why it cannot be fitted, if it cannot.
[[nodiscard]] std::string add_nested_model(const ModelData& data, const AnalysisOptions& options, Finding& finding);
// Its tables, and the methods behind them. Captions begin with `about`.
void add_nested_results(const ModelData& data, const NestedModel& model, const AnalysisOptions& options,
                        Finding& finding, const std::string& about = "");

// All of the above.
[[nodiscard]] Finding analyze_model(const ModelData& data, const AnalysisOptions& options);

// Numbers as cells; missing where they cannot be estimated.
[[nodiscard]] TableCell cell_of(const Estimable<double>& value);
[[nodiscard]] TableCell number_cell(double value);
[[nodiscard]] TableCell text_cell(std::string text);
[[nodiscard]] TableCell count_cell(std::size_t count);
template <typename T>
[[nodiscard]] TableCell cell_of(const Estimable<T>& value, double T::*part) {
  if (value) return number_cell((*value).*part);
  return {};
}
// How the intervals of partial eta squared are made.
[[nodiscard]] Method eta_squared_method(double alpha);
// Adds a method unless the finding has it.
void add_method(Finding& finding, Method method);

// Partial eta squared of an F test with the interval that does not contain 0 exactly if p < alpha.
[[nodiscard]] Estimable<Interval> eta_squared_of(const Estimable<TestResult>& test, double alpha);

// "F(3, 224) = 0.20, p = 0.898"
[[nodiscard]] std::string test_text(const TestResult& test);

/// Warns of the value whose residual is the furthest, if chance hardly explains it: studentised without it, with
/// Bonferroni's correction for the search. @param leverages  by cell. @param squares  sum of squares of residuals.
void warn_of_far_value(std::span<const double> values, std::span<const double> residuals,
                       std::span<const double> leverages, std::span<const std::size_t> cell_of, double df,
                       double squares, std::vector<std::string>& warnings);

}  // namespace kith
