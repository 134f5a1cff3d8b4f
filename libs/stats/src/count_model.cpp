#include "kith/stats/count_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "checks.hpp"
#include "count_cells.hpp"
#include "count_design.hpp"
#include "kith/stats/distributions.hpp"
#include "negative_binomial.hpp"
#include "type_two_test.hpp"

namespace kith {
namespace {

using detail::CountData;
using detail::CountDesign;
using detail::CountFit;

// Why these data define no model whatever the coefficients are; empty if nothing is wrong.
std::string fault_of(std::span<const double> counts, std::span<const Factor> factors) {
  if (counts.empty()) return "there are no observations";
  const auto is_count = [](double count) { return count >= 0.0 && std::isfinite(count) && count == std::floor(count); };
  if (!std::ranges::all_of(counts, is_count)) return "counts must be whole numbers that are not negative";
  if (std::ranges::all_of(counts, [](double count) { return count == 0.0; })) return "all counts are zero";
  for (const auto& factor : factors) {
    if (factor.levels.size() < 2) return factor.name + " has only one level";
    std::vector<double> sums(factor.levels.size(), 0.0);
    for (std::size_t i = 0; i < counts.size(); ++i) sums[factor.codes[i]] += counts[i];
    const auto zero = std::ranges::find(sums, 0.0);
    if (zero != sums.end()) {
      const auto& level = factor.levels[static_cast<std::size_t>(zero - sums.begin())];
      return "all counts of " + factor.name + " " + level + " are zero, so its ratio has no lower bound";
    }
  }
  return {};
}

// Treatment contrasts of all factors but `without`.
CountDesign design_of(const CountData& data, std::span<const Factor> factors, std::size_t without) {
  CountDesign design{std::vector<std::vector<Eigen::Index>>(data.cells.size(), {0}), 1};
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (f == without) continue;
    for (std::size_t c = 0; c < data.cells.size(); ++c) {
      const auto level = static_cast<Eigen::Index>(data.cells[c].levels[f]);
      if (level > 0) design.columns[c].push_back(design.size + level - 1);
    }
    design.size += static_cast<Eigen::Index>(factors[f].levels.size()) - 1;
  }
  return design;
}

bool has_full_rank(const CountData& data, const CountDesign& design) {
  const auto all = [](const detail::CountCell&) { return true; };
  return Eigen::FullPivLU<Eigen::MatrixXd>{detail::products_over(data, design, all)}.rank() == design.size;
}

std::vector<RateRatio> ratios_of(std::span<const Factor> factors, const CountFit& fit,
                                 const Eigen::MatrixXd& covariance, double confidence) {
  const double z_of_interval = normal_quantile(0.5 + confidence / 2.0);
  std::vector<RateRatio> ratios;
  Eigen::Index column = 1;
  for (const auto& factor : factors) {
    for (std::size_t level = 1; level < factor.levels.size(); ++level, ++column) {
      const double log_ratio = fit.coefficients[column];
      const double standard_error = std::sqrt(covariance(column, column));
      const double z = log_ratio / standard_error;
      const double half_width = z_of_interval * standard_error;
      ratios.push_back({factor.name + " " + factor.levels[level] + " / " + factor.levels.front(),
                        {std::exp(log_ratio), std::exp(log_ratio - half_width), std::exp(log_ratio + half_width)},
                        {"z", z, {}, 2.0 * normal_upper(std::abs(z))}});
    }
  }
  return ratios;
}

Estimable<TestResult> likelihood_ratio(const CountFit& full, const std::optional<CountFit>& reduced, double df) {
  if (!reduced) return Estimable<TestResult>::impossible("the model without it could not be fitted");
  return detail::likelihood_ratio_test(std::max(0.0, 2.0 * (full.log_likelihood - reduced->log_likelihood)), df);
}

}  // namespace

Estimable<CountModel> fit_count_model(std::span<const double> counts, std::span<const Factor> factors,
                                      double confidence) {
  using Result = Estimable<CountModel>;
  require_confidence(confidence, "fit_count_model");
  std::vector<Factor> used;
  for (const auto& factor : factors) {
    require_codes(factor, counts.size(), "fit_count_model");
    used.push_back(drop_unused(factor));
  }
  if (const auto fault = fault_of(counts, used); !fault.empty()) return Result::impossible(fault);

  const auto data = detail::summarise_counts(counts, used);
  const auto design = design_of(data, used, used.size());
  if (data.observations <= static_cast<double>(design.size))
    return Result::impossible("there are no more observations than coefficients");
  if (!has_full_rank(data, design))
    return Result::impossible("the factors cannot be told apart: some levels only occur together");
  if (detail::zeros_separate(data, design))
    return Result::impossible("combinations of levels with only zeros leave some ratios without a bound");
  const auto poisson = detail::fit_poisson(data, design);
  const auto fit = poisson ? detail::fit_negative_binomial(data, design) : std::nullopt;
  if (!fit) return Result::impossible("the search for the largest likelihood did not end");

  CountModel model;
  model.log_likelihood = fit->log_likelihood;
  if (fit->alpha > 0.0) model.theta = 1.0 / fit->alpha;
  model.dispersion = detail::pearson_dispersion(data, design, *poisson);
  model.coefficients.assign(fit->coefficients.begin(), fit->coefficients.end());
  const Eigen::MatrixXd covariance = detail::expected_information(data, design, *fit)
                                         .ldlt()
                                         .solve(Eigen::MatrixXd::Identity(design.size, design.size));
  model.ratios = ratios_of(used, *fit, covariance, confidence);
  for (std::size_t f = 0; f < used.size(); ++f) {
    const auto reduced = detail::fit_negative_binomial(data, design_of(data, used, f));
    model.factor_tests.push_back(likelihood_ratio(*fit, reduced, static_cast<double>(used[f].levels.size() - 1)));
  }
  return model;
}

}  // namespace kith
