#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "count_cells.hpp"

namespace kith::detail {

// Which columns of the design matrix are 1 in each cell; all others are 0. Column 0 is the intercept.
struct CountDesign {
  std::vector<std::vector<Eigen::Index>> columns;  // one list per cell
  Eigen::Index size = 1;                           // number of columns
};

// A negative-binomial regression with variance mu + alpha mu^2; alpha = 1 / theta, 0 is Poisson's.
struct CountFit {
  double alpha = 0.0;
  Eigen::VectorXd coefficients;
  double log_likelihood = 0.0;
};

// The fit of largest likelihood among all alpha >= 0; nothing if the coefficients run away to infinity.
// The design has full rank.
[[nodiscard]] std::optional<CountFit> fit_negative_binomial(const CountData& data, const CountDesign& design);

// The same with alpha = 0.
[[nodiscard]] std::optional<CountFit> fit_poisson(const CountData& data, const CountDesign& design);

// Logarithms of the expected counts, one per cell.
[[nodiscard]] Eigen::VectorXd linear_predictor(const CountDesign& design, const Eigen::VectorXd& coefficients);

// Expected information of the coefficients, shape [columns, columns].
[[nodiscard]] Eigen::MatrixXd expected_information(const CountData& data, const CountDesign& design,
                                                   const CountFit& fit);

}  // namespace kith::detail
