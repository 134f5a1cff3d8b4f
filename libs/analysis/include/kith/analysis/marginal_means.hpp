#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/estimable.hpp"
#include "kith/analysis/fixed_effects.hpp"

namespace kith {

/// The estimated marginal mean of a combination of levels [searle1980] (R: emmeans).
struct MarginalMean : LinearEstimate {
  std::vector<std::size_t> levels;  ///< One per factor of MarginalMeans::over.
  std::size_t observations = 0;     ///< That have these levels (and those of the group).
};

/// The marginal means at one combination of levels of the `by` factors: one family of comparisons.
struct MarginalGroup {
  std::string name;                 ///< "common", "common:novice"; empty without `by` factors.
  std::vector<std::size_t> levels;  ///< One per factor of MarginalMeans::by.
  std::vector<MarginalMean> means;  ///< All combinations of levels; the last factor varies fastest.
};

struct MarginalMeans {
  std::vector<std::size_t> over;  ///< Indices of the model's factors.
  std::vector<std::size_t> by;
  std::vector<MarginalGroup> groups;
};

/// Marginal means of every combination of levels of the factors `over`, at each combination of levels of the factors
/// `by`, averaged over all other factors of the model, whose combinations of levels count equally. Intervals are not
/// adjusted.
/// @param over, by  indices of model.design.factors, none twice; `over` is not empty.
/// @throws std::invalid_argument if an index is out of range or occurs twice, or confidence is not in (0, 1).
[[nodiscard]] MarginalMeans marginal_means(const FixedEffects& model, std::span<const std::size_t> over,
                                           std::span<const std::size_t> by = {}, double confidence = 0.95);

/// How p-values and intervals of a family of contrasts are adjusted.
enum class Adjustment {
  kNone,
  kBonferroni,
  kHolm,   ///< Intervals are Bonferroni's: Holm's procedure has no simple ones.
  kFdr,    ///< Benjamini and Hochberg [benjamini1995]; intervals are not adjusted.
  kTukey,  ///< Tukey-Kramer: the studentised range of all means [tukey1949; kramer1956]. For all pairs.
};

/// A weight for every mean of a group, in the order of MarginalGroup::means.
struct MeanContrast {
  std::string name;
  std::vector<double> weights;
};

/// What is wrong with the weights of a contrast; empty if nothing is: as many as means, finite, not all zero, and their
/// sum is 0 within 1e-6 of the largest.
[[nodiscard]] std::string contrast_error(std::span<const double> weights, std::size_t num_means);

/// Every pair of means: "second - first", in the order of R: the first with every later one, then the second.
[[nodiscard]] std::vector<MeanContrast> pairwise_contrasts(const MarginalGroup& group);
/// Estimates the contrasts of one group as one family (R: emmeans::contrast). Contrasts that cannot be estimated do not
/// count in the family.
/// @param means  of the same model.
/// @throws std::invalid_argument if contrast_error() finds fault with one, or confidence is not in (0, 1).
[[nodiscard]] std::vector<LinearEstimate> estimate_contrasts(const FixedEffects& model, const MarginalGroup& means,
                                                             std::span<const MeanContrast> contrasts,
                                                             Adjustment adjustment, double confidence = 0.95);

}  // namespace kith
