#include "kith/analysis/marginal_means.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "checks.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {

std::vector<MarginalGroup> marginal_means(const FixedEffects& model, std::size_t factor, std::optional<std::size_t> by,
                                          double confidence) {
  const auto& design = model.design;
  const auto num_factors = design.factors.size();
  if (factor >= num_factors || (by && (*by >= num_factors || *by == factor)))
    throw std::invalid_argument{"marginal_means: a factor that the model does not have, or the same twice"};
  const auto& levels = design.factors[factor].levels;
  const auto groups = by ? design.factors[*by].levels : std::vector<std::string>{""};
  const double weight = static_cast<double>(levels.size() * groups.size()) / static_cast<double>(design.counts.size());
  std::vector<MarginalGroup> result;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    auto& group = result.emplace_back(MarginalGroup{groups[g], {}});
    for (std::size_t l = 0; l < levels.size(); ++l) {
      std::vector<double> weights(design.counts.size(), 0.0);
      MarginalMean mean;
      for (std::size_t c = 0; c < weights.size(); ++c) {
        if (design.level(c, factor) != l || (by && design.level(c, *by) != g)) continue;
        weights[c] = weight;
        mean.observations += design.counts[c];
      }
      static_cast<LinearEstimate&>(mean) = estimate_combination(model, levels[l], std::move(weights), confidence);
      group.means.push_back(std::move(mean));
    }
  }
  return result;
}

std::string contrast_error(std::span<const double> weights, std::size_t num_means) {
  if (weights.size() != num_means)
    return "it has " + std::to_string(weights.size()) + " weights for " + std::to_string(num_means) + " means";
  double sum = 0.0;
  double largest = 0.0;
  for (const double weight : weights) {
    if (!std::isfinite(weight)) return "a weight is not a finite number";
    sum += weight;
    largest = std::max(largest, std::abs(weight));
  }
  if (largest == 0.0) return "all its weights are zero";
  if (std::abs(sum) > 1e-6 * largest) return "its weights do not sum to zero";
  return "";
}

namespace {

std::vector<LinearEstimate> estimates_of(const FixedEffects& model, const MarginalGroup& means,
                                         std::span<const MeanContrast> contrasts, double confidence) {
  std::vector<LinearEstimate> results;
  for (const auto& contrast : contrasts) {
    const auto error = contrast_error(contrast.weights, means.means.size());
    if (!error.empty())
      throw std::invalid_argument{"estimate_contrasts: contrast '" + contrast.name + "' is none: " + error};
    std::vector<double> weights(model.means.size(), 0.0);
    for (std::size_t m = 0; m < means.means.size(); ++m) {
      for (std::size_t c = 0; c < weights.size(); ++c) weights[c] += contrast.weights[m] * means.means[m].weights[c];
    }
    results.push_back(estimate_combination(model, contrast.name, std::move(weights), confidence));
  }
  return results;
}

void set_adjusted(LinearEstimate& contrast, double p, double critical) {
  auto inference = *contrast.inference;
  inference.p = p;
  inference.low = contrast.estimate - critical * inference.standard_error;
  inference.high = contrast.estimate + critical * inference.standard_error;
  contrast.inference = inference;
}

// Those that have an interval; none if they are not a family.
std::vector<LinearEstimate*> family_of(std::vector<LinearEstimate>& results) {
  std::vector<LinearEstimate*> family;
  for (auto& result : results) {
    if (result.inference) family.push_back(&result);
  }
  if (family.size() < 2) family.clear();
  return family;
}

}  // namespace

std::vector<LinearEstimate> estimate_contrasts(const FixedEffects& model, const MarginalGroup& means,
                                               std::span<const MeanContrast> contrasts, Correction correction,
                                               double confidence) {
  auto results = estimates_of(model, means, contrasts, confidence);
  const auto family = family_of(results);
  if (correction == Correction::kNone || family.empty()) return results;
  const bool widens = correction != Correction::kFdr;
  const double each = (1.0 - confidence) / (widens ? static_cast<double>(family.size()) : 1.0);  // level of an interval
  std::vector<double> p;
  for (const auto* contrast : family) p.push_back(contrast->inference->p_unadjusted);
  p = adjust(p, correction);
  for (std::size_t i = 0; i < family.size(); ++i)
    set_adjusted(*family[i], p[i], -student_t_quantile(each / 2.0, family[i]->inference->df));
  return results;
}

std::vector<LinearEstimate> estimate_pairs(const FixedEffects& model, const MarginalGroup& means, double confidence) {
  const auto num_means = means.means.size();
  std::vector<MeanContrast> pairs;
  for (std::size_t first = 0; first < num_means; ++first) {
    for (std::size_t second = first + 1; second < num_means; ++second) {
      auto& pair = pairs.emplace_back(
          MeanContrast{means.means[second].name + " - " + means.means[first].name, std::vector(num_means, 0.0)});
      pair.weights[first] = -1.0;
      pair.weights[second] = 1.0;
    }
  }
  auto results = estimates_of(model, means, pairs, confidence);
  double df_of_critical = 0.0, critical = 0.0;
  for (auto* pair : family_of(results)) {
    const auto& inference = *pair->inference;
    if (inference.df < 2.0) {
      pair->inference = Estimable<Inference>::impossible("fewer than two degrees of freedom for Tukey's adjustment");
      continue;
    }
    if (inference.df != df_of_critical) {  // the same for all pairs in most designs
      df_of_critical = inference.df;
      critical = studentized_range_quantile(1.0 - confidence, num_means, df_of_critical) / std::numbers::sqrt2;
    }
    const double q = std::numbers::sqrt2 * std::abs(inference.statistic);
    set_adjusted(*pair, studentized_range_upper(q, num_means, inference.df), critical);
  }
  return results;
}

}  // namespace kith
