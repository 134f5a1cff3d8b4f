#include "kith/analysis/fixed_effects.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cell_model.hpp"
#include "checks.hpp"
#include "kith/analysis/distributions.hpp"

namespace kith {
namespace {

// What is no more than the rounding of its parts is 0.
double without_rounding_of(double sum, double size_of_parts) {
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::abs(sum) <= kRounding * size_of_parts ? 0.0 : sum;
}

struct Variance {
  double value = 0.0;
  double df = 0.0;  // Satterthwaite's
};

// @param weights  of the observed means, [cells].
Variance variance_of(const FixedEffects& model, const std::vector<double>& weights) {
  const auto& design = model.design;
  std::vector<double> of_rows;
  of_rows.reserve(design.cell_of.size());
  for (const auto cell : design.cell_of) of_rows.push_back(weights[cell] / static_cast<double>(design.counts[cell]));
  const auto parts = squares_in_strata(of_rows, model.groups);
  Variance variance;
  double uncertainty = 0.0;
  for (const auto& pool : model.pools) {
    double part = 0.0;
    for (std::size_t s = pool.begin; s < pool.end; ++s) part += parts[s] * pool.mean_square;
    variance.value += part;
    uncertainty += part * part / pool.df;
  }
  variance.df = model.pools.size() == 1 ? model.pools.front().df : variance.value * variance.value / uncertainty;
  return variance;
}

}  // namespace

LinearEstimate estimate_combination(const FixedEffects& model, std::string name, std::vector<double> weights,
                                    double confidence) {
  require_confidence(confidence, "estimate_combination");
  require_finite(weights, "estimate_combination");
  if (weights.size() != model.means.size())
    throw std::invalid_argument{"estimate_combination: one weight per cell of the design"};
  const auto of_observed = model.design.weights_of_observed(weights);
  double sum = 0.0, size = 0.0, all = 0.0, size_of_weights = 0.0;
  for (std::size_t c = 0; c < weights.size(); ++c) {
    const double part = of_observed[c] * model.means[c];
    sum += part;
    size += std::abs(part);
    all += weights[c];
    size_of_weights += std::abs(weights[c]);
  }

  LinearEstimate result{std::move(name), std::move(weights)};
  result.estimate = without_rounding_of(sum, size) + model.centre * without_rounding_of(all, size_of_weights);
  if (!model.no_standard_errors.empty()) {
    result.inference = Estimable<Inference>::impossible(model.no_standard_errors);
    return result;
  }
  const auto variance = variance_of(model, of_observed);
  if (!(variance.value > 0.0)) {
    result.inference = Estimable<Inference>::impossible("its standard error is zero");
    return result;
  }
  Inference inference{.standard_error = std::sqrt(variance.value), .df = variance.df};
  inference.statistic = result.estimate / inference.standard_error;
  inference.p = inference.p_unadjusted = student_t_two_sided(inference.statistic, inference.df);
  const double reach = student_t_quantile(0.5 + confidence / 2.0, inference.df) * inference.standard_error;
  inference.low = result.estimate - reach;
  inference.high = result.estimate + reach;
  result.inference = inference;
  return result;
}

}  // namespace kith
