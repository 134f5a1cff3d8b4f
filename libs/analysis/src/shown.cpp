#include "shown.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kith {

std::string pairs_caption(const std::string& factor, const std::string& by, bool is_family) {
  std::string how = is_family ? "Tukey-Kramer" : "t test";
  if (!by.empty()) how = "at each level of " + by + (is_family ? "; " + how : "");
  return "Pairs of " + factor + " (" + how + ")";
}

std::string planned_caption(const std::string& factor, const std::string& by, std::optional<Correction> correction) {
  return "Planned contrasts of " + factor + (by.empty() ? "" : " at each level of " + by) +
         (correction ? fmt::format(" ({} correction)", to_string(*correction)) : "");
}

TermResult term_result(const std::string& subject, std::size_t df, const Estimable<TestResult>& test) {
  TermResult result{.subject = subject, .df = df};
  if (!test) return result;
  result.statistic = test->statistic;
  result.p = test->p;
  if (test->df.size() > 1) result.residual_df = test->df[1];
  return result;
}

TermResult with_effect(TermResult result, const Estimable<Interval>& effect) {
  result.effect = known(effect, &Interval::estimate);
  result.low = known(effect, &Interval::low);
  result.high = known(effect, &Interval::high);
  return result;
}

TestFamily tests_of(const std::vector<TermTest>& tests, TestFamily::Residuals residuals) {
  TestFamily family{.residuals = residuals};
  for (const auto& term : tests) family.tests.push_back(term_result(term.name, term.df, term.test));
  return family;
}

TestFamily tests_of(const AnovaTable& table) {
  TestFamily family;
  for (const auto& term : table.terms) {
    auto& result = family.tests.emplace_back(term_result(term.name, term.df, term.test));
    result.residual_df = static_cast<double>(table.residual_df);
    result.sum_of_squares = term.sum_of_squares;
  }
  return family;
}

std::string residuals_text(const TermResult& test, TestFamily::Residuals residuals) {
  if (!test.residual_df) return "";
  if (std::isinf(*test.residual_df)) return "inf";
  switch (residuals) {
    case TestFamily::Residuals::kWhole:
      return fmt::format("{:.0f}", *test.residual_df);
    case TestFamily::Residuals::kOneDecimal:
      return fmt::format("{:.1f}", *test.residual_df);
    case TestFamily::Residuals::kFourDigits:
      return fmt::format("{:.4g}", *test.residual_df);
  }
  return "";
}

std::string degrees_text(const TermResult& test, TestFamily::Residuals residuals) {
  const auto below = residuals_text(test, residuals);
  return std::to_string(test.df) + (below.empty() ? "" : ", " + below);
}

std::vector<ShownColumn<TermResult>> with_effect_columns(std::vector<ShownColumn<TermResult>> columns) {
  columns.push_back(show(&TermResult::effect, "partial eta squared", ResultKind::kFraction));
  columns.push_back(show(&TermResult::low, "lower limit", ResultKind::kFraction));
  columns.push_back(show(&TermResult::high, "upper limit", ResultKind::kFraction));
  return columns;
}

ResultTable anova_table(const std::string& caption, const TestFamily& family, const AnovaTable& table) {
  const std::vector<ShownColumn<TermResult>> columns{
      show(&TermResult::subject, "term", ResultKind::kText), show(&TermResult::df, "df", ResultKind::kCount),
      show(&TermResult::sum_of_squares, "sum of squares"), show(&TermResult::statistic, "F"),
      show(&TermResult::p, "p-value", ResultKind::kP)};
  auto result = shown(caption, family.tests, with_effect_columns(columns));

  // Residuals have degrees of freedom and a sum of squares; nothing else applies to them.
  auto& residuals = result.rows.emplace_back(std::vector<TableCell>{
      text_cell("residuals"), count_cell(table.residual_df), number_cell(table.residual_sum_of_squares)});
  residuals.resize(result.columns.size(), text_cell(""));
  return result;
}

}  // namespace kith
