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

/// A negative-binomial regression with log link: variance mu + mu^2 / theta (R: MASS::glm.nb), main effects only.
struct CountModel {
  double log_likelihood = 0.0;
  std::optional<double> theta;  ///< Missing: the counts vary no more than Poisson's, whose model this then is.
  double dispersion = 1.0;      ///< Pearson's chi-squared of the Poisson model over its df; < 1: less than Poisson.
  std::vector<RateRatio> ratios;
  std::vector<double> coefficients;  ///< Intercept, then treatment contrasts, factor by factor.
  /// Likelihood-ratio test of each factor, in order, chi-squared; the model without it is fitted anew.
  std::vector<Estimable<TestResult>> factor_tests;
};

/// @param counts  >= 0, whole numbers.
[[nodiscard]] Estimable<CountModel> fit_count_model(std::span<const double> counts, std::span<const Factor> factors,
                                                    double confidence = 0.95);

}  // namespace kith
