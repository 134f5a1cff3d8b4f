#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/factor.hpp"
#include "kith/analysis/fixed_effects.hpp"
#include "kith/analysis/tests.hpp"

namespace kith {

/// The test of a term of a model: that none of its effects differs from 0.
struct TermTest {
  std::string name;    ///< "strategy:composition"
  std::size_t df = 0;  ///< Of the numerator: what the term adds to the model without it.
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
};

/// What rows of a group have in common.
struct GroupVariance {
  std::string name;
  std::size_t groups = 0;
  /// >= 0. 0: in these data, rows of a group are no more alike than other rows.
  double variance = 0.0;
  /// Its share of the variance of a single row, in [0, 1): the correlation of two rows that have this group in common
  /// and no smaller one, given their fixed effects.
  double intraclass_correlation = 0.0;
  /// By how much the variance of the mean of all rows is larger than if they were independent, 1 + (rows in each group
  /// - 1) * intraclass correlation [kish1965].
  double design_effect = 1.0;
  /// With one kind of group a profile likelihood interval, which starts at 0 where a variance of 0 fits nearly as well.
  /// With several, Wald's interval on the log odds; none for a variance of 0.
  Estimable<Interval> intraclass_interval = Estimable<Interval>::impossible("its variance is zero");
  /// Likelihood-ratio test that the variance is 0, chi-squared with one degree of freedom, by REML. Because variances
  /// are not negative, p is up to twice as large as it needs be.
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
};

/// A model y = X beta + sum_k Z_k u_k + e of factors, with random intercepts u_k of groups that are nested in one
/// another: of a balanced design, in which the mixed model's estimates by REML and its F tests are those of an analysis
/// of variance with error strata (R: aov with Error(), lmerTest). Every other design is for lme4.
struct NestedModel {
  /// The cells' means, with Satterthwaite's degrees of freedom; what standardises differences is the standard deviation
  /// of a single row.
  FixedEffects fixed;
  /// F test of every term against the mean square of its stratum. Where groups are no more alike than chance makes
  /// them, the strata are pooled, as REML does.
  std::vector<TermTest> tests;
  std::vector<GroupVariance> groups;  ///< As they were given.
  double residual_variance = 0.0;     ///< > 0
};

/// Fits the model from the mean squares of its strata: between the groups of each level, within those of the level
/// before, and of rows within the smallest groups.
///
/// Not estimable, with a reason: no observations; levels of groups that are not nested or of unequal sizes; a term that
/// is not in one stratum, as in unbalanced designs; factors that tell all groups apart; no spread of rows.
/// @param groups  from the largest to the smallest; one at least.
/// @throws std::invalid_argument if shapes differ, a value is not finite, there are no groups, or confidence is not in
/// (0, 1). Costs O(n c) for n rows and c cells.
[[nodiscard]] Estimable<NestedModel> fit_nested_model(std::span<const double> response, std::span<const Factor> factors,
                                                      std::span<const std::vector<std::size_t>> terms,
                                                      std::span<const Factor> groups, double confidence = 0.95);

}  // namespace kith
