#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/stats/anova.hpp"
#include "kith/stats/effect_size.hpp"
#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"
#include "kith/stats/fixed_effects.hpp"
#include "kith/stats/term_test.hpp"
#include "kith/stats/tests.hpp"

namespace kith {

struct MixedModelOptions {
  bool reml = true;          ///< Restricted maximum likelihood; false: maximum likelihood.
  double confidence = 0.95;  ///< Of the intervals of intraclass correlations; in (0, 1).
  /// Whether to test each random intercept and find the intervals of the intraclass correlations, which costs some ten
  /// more fits.
  bool test_variances = true;
};

/// A random intercept of a fitted model.
struct VarianceComponent {
  std::string name;        ///< "team", "team:member"
  std::size_t groups = 0;  ///< Levels with observations.
  /// >= 0. 0: in these data, rows of a group are no more alike than other rows (lme4: singular fit).
  double variance = 0.0;
  /// Its share of the variance, variance / (sum of all components' variances + residual variance), in [0, 1): the
  /// correlation of two rows that have this group in common and no other, given their fixed effects.
  double intraclass_correlation = 0.0;
  /// With one random intercept a profile likelihood interval, which starts at 0 where a variance of 0 fits nearly as
  /// well. With several, Wald's interval on the log odds with the variances' covariance from the Hessian; none for a
  /// variance of 0.
  Estimable<Interval> intraclass_interval = Estimable<Interval>::impossible("not computed");
  /// Likelihood-ratio test that the variance is 0, chi-squared with one degree of freedom (lmerTest: ranova, which
  /// compares models fitted by REML). Because variances are not negative, p is up to twice as large as it needs be.
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
};

/// A linear mixed model y = X beta + sum_k Z_k u_k + e with factors as fixed effects and random intercepts
/// u_k ~ N(0, variance_k), e ~ N(0, residual variance).
struct MixedModel {
  /// Coefficients with their covariance and Satterthwaite's degrees of freedom: for a combination l of variance
  /// f = l'Cov l, df = 2 f^2 / (g'Ag), where g is the gradient of f by the variance parameters and A their asymptotic
  /// covariance, twice the inverse Hessian of the (restricted) deviance [kuznetsova2017]. The standard deviation that
  /// standardises differences is that of a single row, the root of the sum of all variances.
  FixedEffects fixed;
  std::vector<VarianceComponent> components;  ///< As the groups were given.
  double residual_variance = 0.0;             ///< > 0
  double log_likelihood = 0.0;                ///< Restricted if reml.
  bool reml = true;
  std::size_t observations = 0;
  bool singular = false;  ///< Some component's variance is 0.
};

/// Fits the model as lme4's lmer does [bates2015]: the deviance is profiled over coefficients and residual variance and
/// minimised over the ratios of variances, with derivatives; random effects are solved for by a sparse Cholesky
/// decomposition. Rows that share cell and groups enter by their number, mean and spread.
///
/// Equals lmer to 1e-6 relative, Satterthwaite's df of lmerTest to 1e-4. Costs O(n) for n observations and one sparse
/// decomposition per step, 10 to 30 of them.
///
/// Not estimable, with a reason: no observations; no more observations than coefficients; a grouping factor with one
/// level, or with as many levels as rows; two grouping factors that divide the rows alike; factors that already
/// tell all groups apart; no spread of rows within groups; so many crossed groups that their decomposition would be too
/// large.
///
/// @param response  finite. @param factors, terms  the fixed effects, as in Formula; no terms: the mean alone.
/// @param groups  one or more grouping factors; for (1|a:b) see group_factor().
/// @throws std::invalid_argument if shapes differ, a value is not finite, no groups are given or confidence is not in
///         (0, 1).
[[nodiscard]] Estimable<MixedModel> fit_mixed_model(std::span<const double> response, std::span<const Factor> factors,
                                                    std::span<const std::vector<std::size_t>> terms,
                                                    std::span<const Factor> groups,
                                                    const MixedModelOptions& options = {});

/// The combinations of levels that occur, in the order in which they first do: the groups of (1|a:b), named "a:b".
/// @throws std::invalid_argument without factors or if they differ in length.
[[nodiscard]] Factor group_factor(std::span<const Factor> factors);

/// F test of every term, with Satterthwaite's denominator degrees of freedom (lmerTest: anova(model, type = 2) and
/// type = 3, ddf = "Satterthwaite") [kuznetsova2017]. Type III hypotheses are SAS's estimable functions, which are the
/// sum-to-zero contrasts where no combination of levels is empty. A term of which nothing can be estimated says why.
[[nodiscard]] std::vector<TermTest> term_tests(const FixedEffects& model, SumsOfSquares type);

}  // namespace kith
