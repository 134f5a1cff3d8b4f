#include "kith/analysis/anova.hpp"

#include <cmath>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"

namespace kith {
namespace {

std::string reason_without_df(const CellDesign& design, std::size_t term) {
  for (const auto factor : design.terms[term]) {
    if (design.factors[factor].levels.size() < 2)
      return "only one level of '" + design.factors[factor].name + "' has observations";
  }
  return "";
}

// Why the cells' means have no standard errors, and no term a test; empty if they have.
std::string reason_without_errors(const CellDesign& design, std::size_t residual_df, double residual, double rounding) {
  if (residual_df == 0) return "no residual degrees of freedom: as many parameters as observations";
  if (residual > negligible_sum_of_squares(rounding, design.cell_of.size())) return "";
  return design.model_df() == design.counts.size() ? "no spread within the cells"
                                                   : "no spread around the model's values";
}

// What the cells say of their means. @param residual  of standardised values.
Estimable<FixedEffects> effects_of_cells(const CellDesign& design, const StandardizedResponse& response,
                                         const std::vector<double>& means, double residual, std::size_t df,
                                         std::string no_errors) {
  const double mean_square = no_errors.empty() ? residual / static_cast<double>(df) : 0.0;
  const double unit = std::ldexp(mean_square, 2 * response.exponent);
  if (std::isinf(unit))
    return Estimable<FixedEffects>::impossible("the residual spread is beyond the range of numbers");
  if (no_errors.empty() && unit == 0.0) no_errors = "the residual spread is too small for numbers";
  FixedEffects effects{.design = design, .centre = response.centre, .means = means};
  for (auto& mean : effects.means) mean = std::ldexp(mean, response.exponent);
  effects.pools = {{0, 1, static_cast<double>(df), unit}};
  effects.residual_sd = no_errors.empty() ? Estimable<double>{std::ldexp(std::sqrt(mean_square), response.exponent)}
                                          : Estimable<double>::impossible(no_errors);
  effects.no_standard_errors = std::move(no_errors);
  return effects;
}

}  // namespace

AnovaTable anova(std::span<const double> response, std::span<const Factor> factors,
                 std::span<const std::vector<std::size_t>> terms) {
  require_finite(response, "anova");
  const auto made = make_cell_design(response.size(), factors, terms);
  AnovaTable table;
  table.observations = response.size();
  for (const auto& term : terms) table.terms.push_back({term_name(term, factors)});
  if (!made) {
    for (auto& term : table.terms) test_term(term, 0.0, 0.0, 0, made.reason());
    table.effects = Estimable<FixedEffects>::impossible(made.reason());
    return table;
  }
  const auto& design = *made;
  const auto standardized = standardize(response);
  const auto cells = moments_of(standardized.values, design);
  const auto fitted = design.fitted(cells.means);
  double residual = cells.within;
  for (std::size_t c = 0; c < fitted.size(); ++c)
    residual += static_cast<double>(design.counts[c]) * (cells.means[c] - fitted[c]) * (cells.means[c] - fitted[c]);

  table.balanced = design.is_balanced();
  table.residual_df = response.size() - design.model_df();
  table.residual_sum_of_squares = std::ldexp(residual, 2 * standardized.exponent);
  for (std::size_t i = 0; i < response.size(); ++i)
    table.residuals.push_back(std::ldexp(standardized.values[i] - fitted[design.cell_of[i]], standardized.exponent));
  const auto no_errors = reason_without_errors(design, table.residual_df, residual, standardized.rounding);
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    const double sum_of_squares = term_sum_of_squares(design, t, cells.means);
    table.terms[t].df = design.df(t);
    table.terms[t].sum_of_squares = std::ldexp(sum_of_squares, 2 * standardized.exponent);
    const auto no_df = reason_without_df(design, t);
    test_term(table.terms[t], sum_of_squares, residual, table.residual_df, no_df.empty() ? no_errors : no_df);
  }
  table.effects = effects_of_cells(design, standardized, cells.means, residual, table.residual_df, no_errors);
  return table;
}

Estimable<NormalityCheck> check_normality(std::span<const double> residuals) {
  require_finite(residuals, "check_normality");
  using Result = Estimable<NormalityCheck>;
  if (residuals.size() < 3) return Result::impossible("fewer than three residuals");

  const auto standardized = standardize(residuals);
  const auto n = static_cast<double>(residuals.size());
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (const double value : standardized.values) {
    const double square = value * value;
    second += square / n;
    third += square * value / n;
    fourth += square * square / n;
  }
  if (second * n <= negligible_sum_of_squares(standardized.rounding, residuals.size()))
    return Result::impossible("all residuals are equal");

  NormalityCheck check;
  check.skewness = third / (second * std::sqrt(second));
  check.excess_kurtosis = fourth / (second * second) - 3.0;
  const double statistic =
      n / 6.0 * (check.skewness * check.skewness + check.excess_kurtosis * check.excess_kurtosis / 4.0);
  check.test = {"chi-squared", statistic, {2.0}, chi_squared_upper(statistic, 2.0)};
  return check;
}

}  // namespace kith
