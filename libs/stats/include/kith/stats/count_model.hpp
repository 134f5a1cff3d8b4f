#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/stats/effect_size.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

/// How much larger the expected count is at a level than at the first one, all else equal.
struct RateRatio {
  std::string name;  ///< "strategy joint / individual-low"
  Interval ratio;    ///< Wald interval on the log scale
  TestResult test;   ///< z
};

/// A negative-binomial regression with log link: variance mu + mu^2 / theta, main effects only (R: MASS::glm.nb,
/// treatment contrasts), fitted by maximum likelihood.
///
/// Poisson's regression is its limit of infinite theta, and is what is fitted where theta > 0 finite does not make the
/// counts likelier (R: glm(family = poisson)). If `dispersion` is then below 1, counts vary less than
/// Poisson's: intervals are wider and p-values larger than they need be.
struct CountModel {
  double log_likelihood = 0.0;
  std::optional<double> theta;    ///< > 0. Missing: infinite, this is Poisson's model.
  double dispersion = 1.0;        ///< Pearson's chi-squared of the Poisson model over its df; < 1: less than Poisson.
  std::vector<RateRatio> ratios;  ///< Every level but the first with observations, factor by factor.
  std::vector<double> coefficients;  ///< Intercept, then treatment contrasts, factor by factor; logs of counts.
  /// Likelihood-ratio test of each factor, in order, chi-squared with levels - 1 degrees of freedom. The model without
  /// it is fitted anew, with a theta of its own, which may be finite where that of the whole model is not.
  std::vector<Estimable<TestResult>> factor_tests;
};

/// Fits the model. Levels without observations do not count; the first of the others is what ratios are to. Theta is a
/// root of the derivative of the profile likelihood, searched for around the moments' estimate.
///
/// Not estimable, with a reason: no counts, counts that are not whole and >= 0, only zeros, a factor with
/// one level, levels that only occur together (rank deficiency), a level or combinations of levels with only zeros
/// such that a ratio has no bound (separation), or no more observations than coefficients.
///
/// @param counts   >= 0, whole numbers. @param factors  one code per count each; none: the mean alone.
/// @throws std::invalid_argument if shapes differ or confidence is not in (0, 1).
/// Costs two passes over the counts and a sort; the fit itself runs over combinations of levels and distinct counts.
[[nodiscard]] Estimable<CountModel> fit_count_model(std::span<const double> counts, std::span<const Factor> factors,
                                                    double confidence = 0.95);

}  // namespace kith
