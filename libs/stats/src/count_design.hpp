#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "kith/stats/fixed_effects.hpp"
#include "negative_binomial.hpp"

namespace kith::detail {

// The observed cells of a design in the order of its grid, and which kept columns are 1 in each; frequencies of counts
// are left out.
[[nodiscard]] CountData count_data_of(std::span<const double> counts, const FactorDesign& design);
[[nodiscard]] CountDesign count_design_of(const FactorDesign& design);

// Products of the columns over the cells for which `take` holds: the rank of the design there, without its many rows.
template <typename Take>
[[nodiscard]] Eigen::MatrixXd products_over(const CountData& data, const CountDesign& design, Take take) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(design.size, design.size);
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    if (!take(data.cells[c])) continue;
    for (const auto row : design.columns[c]) {
      for (const auto column : design.columns[c]) products(row, column) += 1.0;
    }
  }
  return products;
}

// Whether a direction of the coefficients leaves the cells with counts alone and lowers cells of zeros, but raises
// none: then the likelihood has no maximum.
[[nodiscard]] bool zeros_separate(const CountData& data, const CountDesign& design);

// Pearson's chi-squared of a Poisson model over its degrees of freedom.
[[nodiscard]] double pearson_dispersion(const CountData& data, const CountDesign& design, const CountFit& poisson);

}  // namespace kith::detail
