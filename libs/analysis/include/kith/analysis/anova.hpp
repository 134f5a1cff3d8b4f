#pragma once

#include <span>
#include <string>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"
#include "kith/analysis/fixed_effects.hpp"
#include "kith/analysis/tests.hpp"

namespace kith {

/// One row of an analysis of variance.
struct AnovaTerm {
  std::string name;  ///< "strategy:composition"
  std::size_t df = 0;
  double sum_of_squares = 0.0;
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
  /// Sum of squares over itself plus the residual one, in [0, 1].
  Estimable<double> partial_eta_squared = Estimable<double>::impossible("not computed");
};

struct AnovaTable {
  std::vector<AnovaTerm> terms;  ///< In the order asked for.
  double residual_sum_of_squares = 0.0;
  std::size_t residual_df = 0;
  std::size_t observations = 0;
  bool balanced = false;          ///< Every cell has the same number of observations.
  std::vector<double> residuals;  ///< One per observation; empty if no model was fitted.
  Estimable<FixedEffects> effects = Estimable<FixedEffects>::impossible("not computed");
};

/// Analysis of variance of a model of factors whose errors are independent and equally large, and its means.
///
/// Computed from the cells' means and sums of squares, after the observations are centred and scaled, so that neither
/// size nor scale of the data matters: equals R's to 1e-10 relative. Only a sum of squares itself can be beyond the
/// range of double, and is then infinite or 0. What cannot be estimated (cells of other numbers than make_cell_design()
/// takes, one level, no residual degrees of freedom, no residual spread beyond the rounding of the values) says why.
///
/// @param response  one value per observation, finite.
/// @param factors   one code per observation each.
/// @param terms     each a set of indices of `factors`.
/// @throws std::invalid_argument if a value is not finite, or as make_cell_design() does.
[[nodiscard]] AnovaTable anova(std::span<const double> response, std::span<const Factor> factors,
                               std::span<const std::vector<std::size_t>> terms);

/// The effect of a factor within blocks, such as strategies that taught the same
/// simulated people: block means are taken out first, so that differences between blocks do not count as noise.
/// Model: response ~ within * between + block, with block nested in `between` (R: aov with Error(block)). Returns the
/// terms `within` and `within:between`, tested against the residual within blocks.
/// Not estimable unless every block has each level of `within` exactly once.
/// @throws std::invalid_argument if a value is not finite, or unless each factor has a code for every one.
[[nodiscard]] Estimable<AnovaTable> blocked_anova(std::span<const double> response, const Factor& within,
                                                  const Factor& between, const Factor& block);

/// Whether the levels of a factor within blocks are compared with equal precision, as the F tests of blocked_anova()
/// assume (sphericity), and by how much their degrees of freedom shrink if not.
struct Sphericity {
  /// Mauchly's test [mauchly1940] (R: mauchly.test), chi-squared approximation to second order. R 4.2 has the number of
  /// levels in a place of the second-order term that needs levels - 1, so its p differs by up to 1e-4. Not estimable
  /// unless blocks - groups >= levels - 1.
  Estimable<TestResult> mauchly = Estimable<TestResult>::impossible("not computed");
  double mauchly_w = 1.0;           ///< In [0, 1]; 1: spherical. 0 if there are too few blocks.
  double greenhouse_geisser = 1.0;  ///< Epsilon in [1 / (levels - 1), 1] [greenhouse1959].
  double huynh_feldt = 1.0;         ///< Epsilon, less conservative, at most 1 [huynh1976].
};
/// Of the same model as blocked_anova(), from the covariances of the levels within groups of blocks. With two levels it
/// always holds, and there is nothing to test.
/// Not estimable as blocked_anova() is not, without spread or residual degrees of freedom. Throws as that does.
[[nodiscard]] Estimable<Sphericity> check_sphericity(std::span<const double> response, const Factor& within,
                                                     const Factor& between, const Factor& block);
/// An F test of blocked_anova() with both degrees of freedom multiplied by epsilon, which makes it valid without
/// sphericity. @throws std::invalid_argument unless it is an F test and epsilon is in (0, 1].
[[nodiscard]] TestResult correct_for_sphericity(const TestResult& test, double epsilon);

/// Skewness and excess kurtosis of residuals with the Jarque-Bera test of normality (asymptotic).
struct NormalityCheck {
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  TestResult test;
};
[[nodiscard]] Estimable<NormalityCheck> check_normality(std::span<const double> residuals);

}  // namespace kith
