#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"
#include "kith/analysis/fixed_effects.hpp"

namespace kith {

/// A linear model of factors with independent errors of equal variance (R: lm with treatment contrasts).
struct LinearModel {
  FixedEffects effects;  ///< df of every combination: residual_df; residual_sd: sqrt(sum of squares / residual_df).
  double residual_sum_of_squares = 0.0;
  std::size_t residual_df = 0;
  std::size_t observations = 0;
};

/// Fits the model to the means of the cells, after the observations are centred and scaled, as anova() does. A
/// residual spread that rounding of the values explains is none, and leaves estimates without standard errors.
///
/// Costs two passes over the observations and O(c p^2) for c cells and p columns.
/// Not estimable as make_factor_design() is not, or if the spread is beyond the range of double.
/// @throws std::invalid_argument as anova() does.
[[nodiscard]] Estimable<LinearModel> fit_linear_model(std::span<const double> response, std::span<const Factor> factors,
                                                      std::span<const std::vector<std::size_t>> terms);

}  // namespace kith
