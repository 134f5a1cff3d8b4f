#include "kith/analysis/linear_model.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "f_test.hpp"

namespace kith {
namespace {

// Means of the cells of the reference grid and their spread; two passes, so that nothing cancels.
struct GridMoments {
  std::vector<double> means;  // [cells]; 0 without observations
  double within = 0.0;
};

GridMoments summarise(std::span<const double> values, const FactorDesign& design) {
  // Differences from a cell's first value: a cell whose values are all equal has exactly no spread.
  GridMoments cells{std::vector<double>(design.counts.size(), 0.0), 0.0};
  std::vector<double> first(design.counts.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto cell = design.cell_of[i];
    if (std::isnan(first[cell])) first[cell] = values[i];
    cells.means[cell] += values[i] - first[cell];
  }
  for (std::size_t c = 0; c < cells.means.size(); ++c) {
    if (design.counts[c] > 0) cells.means[c] = first[c] + cells.means[c] / static_cast<double>(design.counts[c]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - cells.means[design.cell_of[i]];
    cells.within += difference * difference;
  }
  return cells;
}

}  // namespace

Estimable<LinearModel> fit_linear_model(std::span<const double> response, std::span<const Factor> factors,
                                        std::span<const std::vector<std::size_t>> terms) {
  using Result = Estimable<LinearModel>;
  using Eigen::Index;
  require_finite(response, "fit_linear_model");
  const auto design = make_factor_design(response.size(), factors, terms);
  if (!design) return Result::impossible(design.reason());
  const auto standardized = standardize(response);
  const auto cells = summarise(standardized.values, *design);

  const auto p = design->columns.size();
  const auto k = static_cast<Index>(design->kept.size());
  Index rows = 0;
  for (const auto count : design->counts) rows += count > 0 ? 1 : 0;
  Eigen::MatrixXd weighted(rows, k);
  Eigen::VectorXd z(rows);
  Index row = 0;
  for (std::size_t c = 0; c < design->counts.size(); ++c) {
    if (design->counts[c] == 0) continue;
    const double root = std::sqrt(static_cast<double>(design->counts[c]));
    for (Index j = 0; j < k; ++j)
      weighted(row, j) = root * design->grid[c * p + design->kept[static_cast<std::size_t>(j)]];
    z(row) = root * cells.means[c];
    ++row;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr{weighted};
  const Eigen::VectorXd coefficients = qr.solve(z);
  const Eigen::MatrixXd inverse_root =
      qr.matrixQR().topRows(k).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(k, k));
  const double lack_of_fit = rows == k ? 0.0 : (z - weighted * coefficients).squaredNorm();
  const double residual = cells.within + lack_of_fit;

  LinearModel model;
  model.observations = response.size();
  model.residual_df = response.size() - static_cast<std::size_t>(k);
  model.residual_sum_of_squares = std::ldexp(residual, 2 * standardized.exponent);
  std::string no_standard_errors;
  double mean_square = 0.0;  // of standardised values
  if (model.residual_df == 0) {
    no_standard_errors = "no residual degrees of freedom: as many parameters as observations";
  } else if (residual <= negligible_sum_of_squares(standardized.rounding, response.size())) {
    no_standard_errors = rows == k ? "no spread within the cells" : "no spread around the model's values";
  } else {
    mean_square = residual / static_cast<double>(model.residual_df);
  }
  const double unit = std::ldexp(mean_square, 2 * standardized.exponent);
  if (std::isinf(unit)) return Result::impossible("the residual spread is beyond the range of numbers");
  if (no_standard_errors.empty() && unit == 0.0) no_standard_errors = "the residual spread is too small for numbers";

  std::vector<double> estimates(static_cast<std::size_t>(k));
  for (Index j = 0; j < k; ++j)
    estimates[static_cast<std::size_t>(j)] = std::ldexp(coefficients(j), standardized.exponent);
  estimates.front() += standardized.centre;  // the intercept is always kept, and first
  const Eigen::MatrixXd unscaled = inverse_root * inverse_root.transpose();
  const Eigen::MatrixXd covariance = unit * unscaled;
  const auto df = static_cast<double>(model.residual_df);
  model.effects =
      make_fixed_effects(*design, estimates, {covariance.data(), static_cast<std::size_t>(covariance.size())},
                         [df](std::span<const double>) { return df; });
  model.effects.no_standard_errors = no_standard_errors;
  model.effects.residual_sd = no_standard_errors.empty()
                                  ? Estimable<double>{std::ldexp(std::sqrt(mean_square), standardized.exponent)}
                                  : Estimable<double>::impossible(no_standard_errors);
  return model;
}

}  // namespace kith
