#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"

namespace kith {

/// A factor of a model: those of its levels that have observations, in their order.
struct ModelFactor {
  std::string name;
  std::vector<std::string> levels;
  friend bool operator==(const ModelFactor&, const ModelFactor&) = default;
};

/// The design matrix of a model whose terms are factors and interactions of factors: an intercept and treatment
/// contrasts to the first level, coded as R does (a factor is coded by an indicator of every level in terms whose
/// margin the model lacks).
///
/// The reference grid has one cell for every combination of levels, observed or not; the last factor varies fastest.
/// Columns that depend linearly on earlier ones in the observed cells are not fitted; `kept` lists the others.
struct FactorDesign {
  std::vector<ModelFactor> factors;
  std::vector<std::vector<std::size_t>> terms;  ///< Ascending indices of `factors`.
  std::vector<std::string> columns;             ///< "(Intercept)", "strategy[joint]", "strategy[joint]:type[novice]"
  std::vector<std::size_t> term_of;             ///< [columns]: index into `terms`; terms.size() for the intercept.
  std::vector<double> grid;                     ///< [cells, columns], row-major.
  std::vector<std::size_t> counts;              ///< [cells]: observations.
  std::vector<std::size_t> cell_of;             ///< [observations]: index of the cell.
  std::vector<std::size_t> kept;                ///< Independent columns, ascending.
  /// [columns - kept, columns], row-major: a basis of the directions in which the coefficients can move without
  /// changing the expectation of any observation. A linear combination of the coefficients is estimable if it is
  /// orthogonal to all of them [searle1980].
  std::vector<double> null_space;
};

/// Builds the design. Levels without observations are dropped; a factor with one level contributes no columns.
/// Not estimable without observations, or if the reference grid has more than ten million entries.
/// @param factors  one code per observation each. @param terms  sets of indices of `factors`, as in Formula::terms.
/// @throws std::invalid_argument if a factor has another number of codes, a code is no level, or a term names no
/// factor. Costs one pass over the observations and O(c p^2) for c cells and p columns.
[[nodiscard]] Estimable<FactorDesign> make_factor_design(std::size_t observations, std::span<const Factor> factors,
                                                         std::span<const std::vector<std::size_t>> terms);

/// What a fitted model says about linear combinations of its fixed effects: all that marginal means, contrasts and
/// tests of them need, whether rows are independent or in groups.
struct FixedEffects {
  FactorDesign design;
  std::vector<double> coefficients;  ///< [columns] 0 for columns that are not kept.
  std::vector<double> covariance;    ///< [columns, columns], row-major; 0 for columns that are not kept.
  /// Degrees of freedom of the combination, shape [columns]; > 0 and possibly infinite.
  std::function<double(std::span<const double>)> df;
  /// What standardises differences, such as the residual standard deviation.
  Estimable<double> residual_sd = Estimable<double>::impossible("this model has no residual standard deviation");
  /// Why there are no standard errors ("no residual degrees of freedom: ..."); empty if there are.
  std::string no_standard_errors;
};

/// Fixed effects of a model that was fitted to the kept columns of a design, k = design.kept.size(); the rest are the
/// defaults above.
/// @param coefficients  [k]. @param covariance  [k, k], row-major.
/// @param df  degrees of freedom of a combination of the kept columns, shape [k].
/// @throws std::invalid_argument if shapes differ.
[[nodiscard]] FixedEffects make_fixed_effects(FactorDesign design, std::span<const double> coefficients,
                                              std::span<const double> covariance,
                                              std::function<double(std::span<const double>)> df);

/// How sure an estimate is. p is two-sided against 0 and, like the interval, adjusted as the caller asked.
struct Inference {
  double standard_error = 0.0;  ///< > 0
  double df = 0.0;              ///< > 0; infinite: normal.
  double statistic = 0.0;       ///< estimate / standard_error; t, or z if df is infinite.
  double p = 1.0;
  double p_unadjusted = 1.0;
  double low = 0.0;
  double high = 0.0;
};

/// A linear combination of the coefficients.
struct LinearEstimate {
  std::string name;
  std::vector<double> combination;  ///< [columns]
  Estimable<double> estimate = Estimable<double>::impossible("not computed");
  /// Without it the estimate may still be known: one observation per cell, or no residual spread.
  Estimable<Inference> inference = Estimable<Inference>::impossible("not computed");
};

/// Estimates sum_j combination_j coefficient_j. The reason of what cannot be estimated names a combination of levels
/// without observations, if there is one that matters.
/// @throws std::invalid_argument unless the combination has one weight per column and confidence is in (0, 1).
[[nodiscard]] LinearEstimate estimate_combination(const FixedEffects& model, std::string name,
                                                  std::vector<double> combination, double confidence = 0.95);

}  // namespace kith
