#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"

namespace kith {

/// A log-linear model of counts, some of which may only be known to be larger than a bound: negative binomial with
/// variance mu + mu^2 / theta (R: MASS::glm.nb), or Poisson, the limit of infinite theta, where no finite theta is
/// likelier. A censored count y contributes log P(Y > y) to the log-likelihood, any other log P(Y = y).
struct CountModel {
  /// On the log scale; degrees of freedom are infinite. Covariance: inverse of the expected information of the
  /// coefficients; if counts are censored, of the observed information of coefficients and log(theta).
  FixedEffects fixed;
  std::optional<double> theta;  ///< > 0. Missing: infinite, this is Poisson's model.
  double log_likelihood = 0.0;
  std::size_t observations = 0;
  std::size_t censored = 0;
  /// Likelihood-ratio test of every term, chi-squared, of type II: between the models of all terms that do not contain
  /// it, with and without it, each with a theta of its own.
  std::vector<TermTest> term_tests;
};

/// Fits the model by maximum likelihood: Newton's method for the coefficients, a root of the derivative of the profile
/// likelihood for theta.
///
/// Not estimable, with a reason: no observations, counts that are not whole and >= 0, everything censored, only zeros,
/// no more observations than coefficients, or combinations of levels that leave a ratio without a bound (all zero, all
/// censored).
///
/// @param counts  one per observation. @param observed  false: censored, the true count is larger. Empty: none is.
/// @param factors, terms  as in Formula; no terms: the mean alone.
/// @throws std::invalid_argument if shapes differ.
/// Costs two passes over the counts; the fit itself runs over combinations of levels and distinct counts.
[[nodiscard]] Estimable<CountModel> fit_count_model(std::span<const double> counts, const std::vector<bool>& observed,
                                                    std::span<const Factor> factors,
                                                    std::span<const std::vector<std::size_t>> terms);

}  // namespace kith
