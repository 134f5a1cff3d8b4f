#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/analysis/cell_design.hpp"

namespace kith {

/// What a fitted model says about linear combinations of the means of its cells: all that marginal means and contrasts
/// need, whether rows are independent or in groups.
struct FixedEffects {
  /// Strata of the errors that have one variance: between groups, within them.
  struct Pool {
    std::size_t begin = 0, end = 0;  ///< Strata; the last one is that of rows.
    double df = 0.0;
    double mean_square = 0.0;
  };

  CellDesign design;
  double centre = 0.0;
  std::vector<double> means{};   ///< [cells] of the observations, less the centre.
  std::vector<Factor> groups{};  ///< Nested in one another, of equal sizes; none: rows are independent.
  std::vector<Pool> pools{};     ///< From the largest groups to rows.
  /// What standardises differences, such as the residual standard deviation.
  Estimable<double> residual_sd = Estimable<double>::impossible("this model has no residual standard deviation");
  /// Why there are no standard errors ("no residual degrees of freedom: ..."); empty if there are.
  std::string no_standard_errors{};
};

/// How sure an estimate is. p is two-sided against 0 and, like the interval, adjusted as the caller asked.
struct Inference {
  double standard_error = 0.0;  ///< > 0
  double df = 0.0;              ///< > 0; Satterthwaite's where groups are alike.
  double statistic = 0.0;       ///< t: estimate / standard_error
  double p = 1.0;
  double p_unadjusted = 1.0;
  double low = 0.0;
  double high = 0.0;
};

/// A linear combination of the means of cells that a model expects.
struct LinearEstimate {
  std::string name;
  std::vector<double> weights;  ///< [cells]
  double estimate = 0.0;
  /// Not estimable with one observation per cell, or without residual spread.
  Estimable<Inference> inference = Estimable<Inference>::impossible("not computed");
};

/// Estimates sum_c weight_c mean_c.
/// @throws std::invalid_argument unless there is one weight per cell and confidence is in (0, 1).
[[nodiscard]] LinearEstimate estimate_combination(const FixedEffects& model, std::string name,
                                                  std::vector<double> weights, double confidence = 0.95);

}  // namespace kith
