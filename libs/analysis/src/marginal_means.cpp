#include "kith/analysis/marginal_means.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "checks.hpp"
#include "inference.hpp"
#include "kith/analysis/distributions.hpp"
#include "kith/analysis/multiple.hpp"

namespace kith {
namespace {

void require_factors(const FactorDesign& design, std::span<const std::size_t> over, std::span<const std::size_t> by) {
  if (over.empty()) throw std::invalid_argument{"marginal_means: at least one factor to keep the levels of is needed"};
  std::vector<bool> seen(design.factors.size(), false);
  for (const auto indices : {over, by}) {
    for (const auto factor : indices) {
      if (factor >= seen.size()) throw std::invalid_argument{"marginal_means: a factor that the model does not have"};
      if (seen[factor]) throw std::invalid_argument{"marginal_means: a factor is named twice"};
      seen[factor] = true;
    }
  }
}

// The cells of the reference grid by their levels of some factors.
class Projection {
 public:
  Projection(const FactorDesign& design, std::vector<std::size_t> factors)
      : design_{&design}, factors_{std::move(factors)} {}

  [[nodiscard]] std::size_t size() const {
    std::size_t product = 1;
    for (const auto factor : factors_) product *= design_->factors[factor].levels.size();
    return product;
  }
  [[nodiscard]] std::size_t index_of(std::span<const std::size_t> levels_of_cell) const {
    std::size_t index = 0;
    for (const auto factor : factors_) index = index * design_->factors[factor].levels.size() + levels_of_cell[factor];
    return index;
  }
  [[nodiscard]] std::vector<std::size_t> levels(std::size_t index) const {
    std::vector<std::size_t> levels(factors_.size());
    for (std::size_t f = levels.size(); f-- > 0;) {
      const auto num_levels = design_->factors[factors_[f]].levels.size();
      levels[f] = index % num_levels;
      index /= num_levels;
    }
    return levels;
  }
  [[nodiscard]] std::string name(std::size_t index) const {
    std::string name;
    const auto at = levels(index);
    for (std::size_t f = 0; f < at.size(); ++f)
      name += (f == 0 ? "" : ":") + design_->factors[factors_[f]].levels[at[f]];
    return name;
  }

 private:
  const FactorDesign* design_;
  std::vector<std::size_t> factors_;
};

// "no observation has strategy 'joint' and composition 'mixed'"
std::string describe_empty_cell(const FactorDesign& design, std::size_t cell) {
  std::string text = "no observation has ";
  const auto levels = levels_of_cell(design, cell);
  for (std::size_t f = 0; f < levels.size(); ++f)
    text += (f == 0 ? "" : " and ") + design.factors[f].name + " '" + design.factors[f].levels[levels[f]] + "'";
  return text;
}

struct Accumulated {
  std::vector<double> combination;
  std::vector<std::size_t> empty_cells;
  std::size_t observations = 0;
};

std::string empty_cells_reason(const FactorDesign& design, const std::vector<std::size_t>& empty_cells) {
  auto reason = describe_empty_cell(design, empty_cells.front());
  const auto more = empty_cells.size() - 1;
  if (more > 0)
    reason += " (nor " + std::to_string(more) + (more == 1 ? " other combination" : " other combinations") + " needed)";
  return reason;
}

}  // namespace

MarginalMeans marginal_means(const FixedEffects& model, std::span<const std::size_t> over,
                             std::span<const std::size_t> by, double confidence) {
  require_confidence(confidence, "marginal_means");
  const auto& design = model.design;
  require_factors(design, over, by);
  MarginalMeans result{{over.begin(), over.end()}, {by.begin(), by.end()}, {}};
  auto indices = result.by;
  indices.insert(indices.end(), over.begin(), over.end());
  const Projection kept{design, indices};
  const Projection groups{design, result.by};
  const Projection means{design, result.over};

  const auto p = design.columns.size();
  std::vector<Accumulated> sums(kept.size(), {std::vector<double>(p, 0.0), {}, 0});
  const double weight = static_cast<double>(kept.size()) / static_cast<double>(design.counts.size());
  for (std::size_t c = 0; c < design.counts.size(); ++c) {
    auto& sum = sums[kept.index_of(levels_of_cell(design, c))];
    sum.observations += design.counts[c];
    if (design.counts[c] == 0) sum.empty_cells.push_back(c);
    for (std::size_t j = 0; j < p; ++j) sum.combination[j] += weight * design.grid[c * p + j];
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    MarginalGroup group{groups.name(g), groups.levels(g), {}};
    for (std::size_t m = 0; m < means.size(); ++m) {
      auto& sum = sums[g * means.size() + m];
      MarginalMean mean;
      static_cast<LinearEstimate&>(mean) =
          estimate_combination(model, means.name(m), std::move(sum.combination), confidence);
      if (!mean.estimate && !sum.empty_cells.empty()) {
        const auto reason = empty_cells_reason(design, sum.empty_cells);
        mean.estimate = Estimable<double>::impossible(reason);
        mean.inference = Estimable<Inference>::impossible(reason);
      }
      mean.levels = means.levels(m);
      mean.observations = sum.observations;
      group.means.push_back(std::move(mean));
    }
    result.groups.push_back(std::move(group));
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

std::vector<MeanContrast> pairwise_contrasts(const MarginalGroup& group) {
  std::vector<MeanContrast> contrasts;
  const auto& means = group.means;
  for (std::size_t first = 0; first < means.size(); ++first) {
    for (std::size_t second = first + 1; second < means.size(); ++second) {
      contrasts.push_back({means[second].name + " - " + means[first].name, std::vector<double>(means.size(), 0.0)});
      contrasts.back().weights[first] = -1.0;
      contrasts.back().weights[second] = 1.0;
    }
  }
  return contrasts;
}

namespace {

Correction correction_of(Adjustment adjustment) {
  switch (adjustment) {
    case Adjustment::kBonferroni:
      return Correction::kBonferroni;
    case Adjustment::kHolm:
      return Correction::kHolm;
    case Adjustment::kFdr:
      return Correction::kFdr;
    default:
      return Correction::kNone;
  }
}

void set_interval(LinearEstimate& contrast, double critical) {
  auto inference = *contrast.inference;
  inference.low = *contrast.estimate - critical * inference.standard_error;
  inference.high = *contrast.estimate + critical * inference.standard_error;
  contrast.inference = inference;
}

void set_p(LinearEstimate& contrast, double p) {
  auto inference = *contrast.inference;
  inference.p = p;
  contrast.inference = inference;
}

// Adjusts p-values, and widens the interval to the level of the family where the procedure has simple ones.
void adjust_one_by_one(std::span<LinearEstimate*> family, Adjustment adjustment, double confidence) {
  const bool widens = adjustment == Adjustment::kBonferroni || adjustment == Adjustment::kHolm;
  const double each = (1.0 - confidence) / (widens ? static_cast<double>(family.size()) : 1.0);  // level of an interval
  std::vector<double> p;
  for (const auto* contrast : family) p.push_back(contrast->inference->p_unadjusted);
  p = adjust(p, correction_of(adjustment));
  for (std::size_t i = 0; i < family.size(); ++i) {
    set_p(*family[i], p[i]);
    set_interval(*family[i], -student_t_quantile(each / 2.0, family[i]->inference->df));
  }
}

void adjust_by_range(std::span<LinearEstimate*> family, std::size_t num_means, double confidence) {
  double df_of_critical = 0.0;
  double critical = 0.0;
  for (auto* contrast : family) {
    const double df = contrast->inference->df;
    if (df < 2.0) {
      contrast->inference =
          Estimable<Inference>::impossible("fewer than two degrees of freedom for Tukey's adjustment");
      continue;
    }
    if (df != df_of_critical) {  // the same for all contrasts of a linear model
      critical = studentized_range_quantile(1.0 - confidence, num_means, df) / std::numbers::sqrt2;
      df_of_critical = df;
    }
    const double q = std::numbers::sqrt2 * std::abs(contrast->inference->statistic);
    set_p(*contrast, studentized_range_upper(q, num_means, df));
    set_interval(*contrast, critical);
  }
}

}  // namespace

std::vector<LinearEstimate> estimate_contrasts(const FixedEffects& model, const MarginalGroup& means,
                                               std::span<const MeanContrast> contrasts, Adjustment adjustment,
                                               double confidence) {
  require_confidence(confidence, "estimate_contrasts");
  std::vector<LinearEstimate> results;
  std::vector<bool> in_family(means.means.size(), false);
  for (const auto& contrast : contrasts) {
    const auto error = contrast_error(contrast.weights, means.means.size());
    if (!error.empty())
      throw std::invalid_argument{"estimate_contrasts: contrast '" + contrast.name + "' is none: " + error};
    std::vector<double> combination(model.coefficients.size(), 0.0);
    for (std::size_t m = 0; m < means.means.size(); ++m) {
      if (contrast.weights[m] == 0.0) continue;
      for (std::size_t j = 0; j < combination.size(); ++j)
        combination[j] += contrast.weights[m] * means.means[m].combination[j];
    }
    results.push_back(estimate_combination(model, contrast.name, std::move(combination), confidence));
    auto& result = results.back();
    for (std::size_t m = 0; m < means.means.size(); ++m) {
      if (contrast.weights[m] == 0.0) continue;
      if (result.estimate) {
        in_family[m] = true;
      } else if (!means.means[m].estimate) {
        result.estimate = Estimable<double>::impossible(means.means[m].estimate.reason());
        result.inference = Estimable<Inference>::impossible(means.means[m].estimate.reason());
        break;
      }
    }
  }
  std::vector<LinearEstimate*> family;
  for (auto& result : results) {
    if (result.inference) family.push_back(&result);
  }
  if (family.size() < 2) return results;
  if (adjustment == Adjustment::kTukey) {
    const auto num_means = static_cast<std::size_t>(std::count(in_family.begin(), in_family.end(), true));
    adjust_by_range(family, num_means, confidence);
  } else if (adjustment != Adjustment::kNone) {
    adjust_one_by_one(family, adjustment, confidence);
  }
  return results;
}

}  // namespace kith
