#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model.hpp"

namespace kith {

[[nodiscard]] inline TableCell cell_of(const std::optional<double>& value) {
  return value ? number_cell(*value) : TableCell{};
}
[[nodiscard]] inline TableCell cell_of(const std::string& text) { return text_cell(text); }
[[nodiscard]] inline TableCell cell_of(std::size_t count) { return count_cell(count); }

// A column of a table of results: its head, and the cell of a result.
template <typename Result>
struct ShownColumn {
  ResultColumn column;
  std::function<TableCell(const Result&)> cell;
};

template <typename Result, typename Part>
[[nodiscard]] ShownColumn<Result> show(Part Result::*part, std::string name, ResultKind kind = ResultKind::kNumber,
                                       std::string field = "") {
  return {{std::move(name), kind, std::move(field)}, [part](const Result& one) { return cell_of(one.*part); }};
}

// One row per result.
template <typename Result>
[[nodiscard]] ResultTable shown(std::string caption, const std::vector<Result>& results,
                                const std::vector<ShownColumn<Result>>& columns) {
  ResultTable table{std::move(caption), {}, {}};
  for (const auto& column : columns) table.columns.push_back(column.column);
  for (const auto& result : results) {
    auto& row = table.rows.emplace_back();
    for (const auto& column : columns) row.push_back(column.cell(result));
  }
  return table;
}

// The value as one that may be missing.
template <typename T>
[[nodiscard]] std::optional<double> known(const Estimable<T>& value, double T::*part) {
  return value ? std::optional{(*value).*part} : std::nullopt;
}
[[nodiscard]] inline std::optional<double> known(const Estimable<double>& value) {
  return value ? std::optional{*value} : std::nullopt;
}

// Captions of tables that analysis.R makes as well.
inline constexpr const char* kAnovaCaption = "Analysis of variance (type II)";
inline constexpr const char* kWelchCaption = "Test that does not assume equal variances (Welch)";
inline constexpr const char* kMixedCaption = "Tests of the fixed effects (type II, Satterthwaite)";
inline constexpr const char* kVariancesCaption = "Variances and intraclass correlations";
inline constexpr const char* kMeansCaption = "Estimated marginal means of ";  // and the factor
// "Pairs of strategy (Tukey-Kramer)". @param by  the factor at each level of which they are compared, or nothing.
[[nodiscard]] std::string pairs_caption(const std::string& factor, const std::string& by, bool is_family);
// "Planned contrasts of strategy (holm correction)"
[[nodiscard]] std::string planned_caption(const std::string& factor, const std::string& by,
                                          std::optional<Correction> correction);

// A test as a result; with the effect size that the analysis gives, if any.
[[nodiscard]] TermResult term_result(const std::string& subject, std::size_t df, const Estimable<TestResult>& test);
[[nodiscard]] TermResult with_effect(TermResult result, const Estimable<Interval>& effect);
// All terms of an analysis of variance.
[[nodiscard]] TestFamily tests_of(const AnovaTable& table);
[[nodiscard]] TestFamily tests_of(const std::vector<TermTest>& tests, TestFamily::Residuals residuals);

// "3, 223.6": the degrees of freedom of an F test, as its family writes them; "3" without those of residuals.
[[nodiscard]] std::string degrees_text(const TermResult& test, TestFamily::Residuals residuals);
// Those of residuals alone; empty without any.
[[nodiscard]] std::string residuals_text(const TermResult& test, TestFamily::Residuals residuals);

// Partial eta squared and its limits.
[[nodiscard]] std::vector<ShownColumn<TermResult>> with_effect_columns(std::vector<ShownColumn<TermResult>> columns);
// Terms with degrees of freedom, sums of squares, F, p and effects, and the residuals.
[[nodiscard]] ResultTable anova_table(const std::string& caption, const TestFamily& family, const AnovaTable& table);

}  // namespace kith
