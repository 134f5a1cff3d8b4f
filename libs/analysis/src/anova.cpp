#include "kith/analysis/anova.hpp"

#include <cmath>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"

namespace kith {
namespace {

std::vector<double> residuals_of(const CellModel& model, const StandardizedResponse& response,
                                 const Eigen::VectorXd& z) {
  const Eigen::VectorXd fitted = model.fitted(z);
  std::vector<double> residuals(response.values.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const auto cell = static_cast<Eigen::Index>(model.cell_of()[i]);
    residuals[i] = std::ldexp(response.values[i] - fitted(cell), response.exponent);
  }
  return residuals;
}

}  // namespace

AnovaTable anova(std::span<const double> response, std::span<const Factor> factors,
                 std::span<const std::vector<std::size_t>> terms, SumsOfSquares type) {
  require_finite(response, "anova");
  const CellModel model{response.size(), factors, terms, type};
  const auto standardized = standardize(response);

  AnovaTable table;
  table.type = type;
  table.observations = response.size();
  table.balanced = model.balanced();
  table.empty_cells = model.empty_cells();
  for (const auto& term : model.terms()) {
    table.terms.push_back({term.name, term.df});
    if (!term.reason.empty()) test_term(table.terms.back(), 0.0, 0.0, 0, term.reason);
  }
  if (!model.reason().empty()) return table;

  const auto cells = model.summarize(standardized.values);
  const double residual = cells.within + model.lack_of_fit(cells.weighted_means);
  const bool no_spread = residual <= negligible_sum_of_squares(standardized.rounding, response.size());
  table.residual_df = model.residual_df();
  table.residual_sum_of_squares = std::ldexp(residual, 2 * standardized.exponent);
  table.residuals = residuals_of(model, standardized, cells.weighted_means);
  for (std::size_t t = 0; t < table.terms.size(); ++t) {
    auto reason = model.terms()[t].reason;
    if (reason.empty() && no_spread)
      reason = model.saturated() ? "no spread within the cells" : "no spread around the model's values";
    const double sum_of_squares = model.term_sum_of_squares(t, cells.weighted_means);
    table.terms[t].sum_of_squares = std::ldexp(sum_of_squares, 2 * standardized.exponent);
    test_term(table.terms[t], sum_of_squares, residual, table.residual_df, reason);
  }
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
