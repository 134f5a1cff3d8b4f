#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"

namespace kith {

/// A log-linear model of counts whose variance is dispersion * mean, for counts that vary less or more than Poisson's
/// [mccullagh1989] (R: glm(family = quasipoisson)).
struct QuasiPoissonModel {
  /// On the log scale, with the covariance of Poisson's regression times the dispersion; tests are t with the residual
  /// degrees of freedom.
  FixedEffects fixed;
  double dispersion = 1.0;  ///< Pearson's chi-squared over its degrees of freedom; < 1: underdispersed.
  std::size_t residual_df = 0;
  std::size_t observations = 0;
  /// F test of every term, of type II: the difference of deviances of the models of all terms that do not contain it,
  /// with and without it, over its degrees of freedom and the dispersion (R: car::Anova(type = 2, test = "F")).
  std::vector<TermTest> term_tests;
};

/// Fits the model. Not estimable, with a reason: no observations, negative values, only zeros, no more observations
/// than coefficients, combinations of levels with only zeros that leave a ratio without a bound, or no spread.
/// @param counts  one per observation; need not be whole. @param factors, terms  as in Formula; no terms: the mean.
/// @throws std::invalid_argument if shapes differ or a value is not finite.
/// Costs two passes over the counts; the fit itself runs over combinations of levels.
[[nodiscard]] Estimable<QuasiPoissonModel> fit_quasi_poisson(std::span<const double> counts,
                                                             std::span<const Factor> factors,
                                                             std::span<const std::vector<std::size_t>> terms);

}  // namespace kith
