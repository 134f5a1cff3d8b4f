#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/stats/effect_size.hpp"
#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

/// Where one level of an ordinal response ends and the next begins, on the scale of the log odds.
struct Threshold {
  std::string name;  ///< "agree|strongly agree"
  double estimate = 0.0;
  double standard_error = 0.0;
};

/// The odds of a higher response with a coefficient's indicator over those without it, all else equal.
struct OddsRatio {
  std::string name;  ///< Column of the design: "strategy[joint]"
  Interval ratio;    ///< Wald interval on the log scale
  TestResult test;   ///< z
};

/// A proportional odds model of an ordinal response with levels 1 < ... < J:
/// log(P(y <= j) / P(y > j)) = threshold_j - x'beta [mccullagh1980]. Fitted by maximum likelihood (R: MASS::polr,
/// ordinal::clm).
struct CumulativeLogit {
  /// Of the latent scale, log odds of a higher response, whose zero is the mean of the thresholds: the intercept is
  /// minus this mean (emmeans: mode = "latent"). Degrees of freedom are infinite. Covariance: inverse of the observed
  /// information. Latent values have a standard deviation of pi / sqrt(3) about x'beta, which standardises differences.
  FixedEffects fixed;
  std::vector<std::string> levels;     ///< Those with observations, in order.
  std::vector<Threshold> thresholds;   ///< levels - 1, ascending.
  std::vector<OddsRatio> odds_ratios;  ///< Every kept column but the intercept.
  double log_likelihood = 0.0;
  std::size_t observations = 0;
  /// Likelihood-ratio test of every term, chi-squared, of type II: between the models of all terms that do not contain
  /// it, with and without it (R: car::Anova).
  std::vector<TermTest> term_tests;
  /// Brant's Wald test that the coefficients are the same at all thresholds, chi-squared with (J - 2) times the number
  /// of coefficients as degrees of freedom [brant1990]. Not estimable with two levels, without coefficients, or if a
  /// split of the levels in two has no maximum of its likelihood.
  Estimable<TestResult> proportional_odds = Estimable<TestResult>::impossible("not computed");
};

/// Fits the model by Newton's method. With two levels it is logistic regression.
///
/// Not estimable, with a reason: no observations, responses with one level, no more observations than parameters, or
/// combinations of levels that separate low from high responses so that an odds ratio has no bound.
///
/// @param response  levels in ascending order; those without observations do not count.
/// @param factors, terms  as in Formula; no terms: the thresholds alone.
/// @throws std::invalid_argument if shapes differ or confidence is not in (0, 1).
/// Costs two passes over the observations; the fit itself runs over combinations of levels.
[[nodiscard]] Estimable<CumulativeLogit> fit_cumulative_logit(const Factor& response, std::span<const Factor> factors,
                                                              std::span<const std::vector<std::size_t>> terms,
                                                              double confidence = 0.95);

}  // namespace kith
