#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/fixed_effects.hpp"
#include "kith/analysis/multiple.hpp"

namespace kith {

/// The estimated marginal mean of a level of a factor [searle1980] (R: emmeans).
struct MarginalMean : LinearEstimate {
  std::size_t observations = 0;  ///< That have this level (and that of the group).
};

/// The marginal means at one level of the `by` factor: one family of comparisons.
struct MarginalGroup {
  std::string name;  ///< The level; empty without a `by` factor.
  std::vector<MarginalMean> means;
};

/// Marginal means of every level of a factor, at each level of the factor `by` if there is one, averaged over all other
/// factors of the model, whose combinations of levels count equally. Intervals are not adjusted.
/// @param factor, by  indices of model.design.factors.
/// @throws std::invalid_argument if they are not, or the same, or confidence is not in (0, 1).
[[nodiscard]] std::vector<MarginalGroup> marginal_means(const FixedEffects& model, std::size_t factor,
                                                        std::optional<std::size_t> by = std::nullopt,
                                                        double confidence = 0.95);

/// A weight for every mean of a group, in the order of MarginalGroup::means.
struct MeanContrast {
  std::string name;
  std::vector<double> weights;
};

/// What is wrong with the weights of a contrast; empty if nothing is: as many as means, finite, not all zero, and their
/// sum is 0 within 1e-6 of the largest.
[[nodiscard]] std::string contrast_error(std::span<const double> weights, std::size_t num_means);

/// Estimates the contrasts of one group as one family (R: emmeans::contrast). Intervals are Bonferroni's where the
/// p-values are his or Holm's, whose procedure has no simple ones, and not adjusted for false discovery rates.
/// @param means  of the same model.
/// @throws std::invalid_argument if contrast_error() finds fault with one, or confidence is not in (0, 1).
[[nodiscard]] std::vector<LinearEstimate> estimate_contrasts(const FixedEffects& model, const MarginalGroup& means,
                                                             std::span<const MeanContrast> contrasts,
                                                             Correction correction, double confidence = 0.95);
/// Estimates every pair of means: "second - first", in the order of R: the first with every later one, then the second.
/// More than one pair are adjusted by Tukey-Kramer: the studentised range of all means [tukey1949; kramer1956].
[[nodiscard]] std::vector<LinearEstimate> estimate_pairs(const FixedEffects& model, const MarginalGroup& means,
                                                         double confidence = 0.95);

}  // namespace kith
