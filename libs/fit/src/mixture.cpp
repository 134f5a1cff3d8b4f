#include "mixture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace kith {

double detail::log_sum(const std::vector<double>& logs) {
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double x : logs) sum += std::exp(x - top);
  return top + std::log(sum);
}

namespace {

using detail::log_sum;

// The probabilities of the types for every person; returns the log-likelihood of all.
double assign_types(const LikelihoodSurface& surface, const PopulationLimits& limits,
                    const std::vector<double>& weights, MixtureFit& fit) {
  std::vector<PopulationMasses> masses;
  for (const auto& type : fit.types) masses.push_back(masses_of(surface, type.parameters, limits, type.gains));
  fit.probability.assign(surface.num_people(), {});
  double total = 0.0;
  for (std::size_t i = 0; i < surface.num_people(); ++i) {
    std::vector<double> logs;
    for (std::size_t k = 0; k < masses.size(); ++k) {
      logs.push_back(std::log(fit.shares[k]) + log_marginal(surface, i, masses[k]));
    }
    const double sum = log_sum(logs);
    if (weights[i] > 0.0) total += weights[i] * sum;
    for (const double x : logs) fit.probability[i].push_back(std::exp(x - sum));
  }
  return total;
}

// Types of equal shares, the people sorted by mean ability.
MixtureFit first_guess(const LikelihoodSurface& surface, std::size_t num_types, const PopulationLimits& limits,
                       const std::vector<double>& weights) {
  const auto one = fit_population(surface, weights, limits, GainModel::kFree);
  MixtureFit fit;
  for (std::size_t k = 0; k < num_types; ++k) {
    auto type = one;
    const double z = num_types == 1 ? 0.0 : 2.0 * static_cast<double>(k) / static_cast<double>(num_types - 1) - 1.0;
    type.parameters.ability_mean = std::clamp(one.parameters.ability_mean + z * one.parameters.ability_sd, 0.52, 0.98);
    if (num_types > 1) type.parameters.ability_sd = std::max(0.6 * one.parameters.ability_sd, 0.01);
    fit.types.push_back(type);
    fit.shares.push_back(1.0 / static_cast<double>(num_types));
  }
  return fit;
}

}  // namespace

MixtureFit detail::fit_weighted_mixture(const LikelihoodSurface& surface, std::size_t num_types,
                                        const PopulationLimits& limits, const std::vector<double>& weights) {
  auto fit = first_guess(surface, num_types, limits, weights);
  double last = assign_types(surface, limits, weights, fit);
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (; fit.rounds < 100; ++fit.rounds) {
    for (std::size_t k = 0; k < num_types; ++k) {
      std::vector<double> of_type;
      for (std::size_t i = 0; i < weights.size(); ++i) of_type.push_back(weights[i] * fit.probability[i][k]);
      fit.shares[k] = std::max(std::accumulate(of_type.begin(), of_type.end(), 0.0) / all, 1e-6);
      fit.types[k] = fit_population(surface, of_type, limits, GainModel::kFree, fit.types[k].parameters);
    }
    fit.log_likelihood = assign_types(surface, limits, weights, fit);
    if (fit.log_likelihood - last < 1e-3) break;
    last = fit.log_likelihood;
  }
  return fit;
}

namespace {

void sort_types(MixtureFit& fit) {
  std::vector<std::size_t> order(fit.types.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fit.types[a].parameters.ability_mean < fit.types[b].parameters.ability_mean;
  });
  auto sorted = fit;
  for (std::size_t k = 0; k < order.size(); ++k) {
    sorted.types[k] = fit.types[order[k]];
    sorted.shares[k] = fit.shares[order[k]];
    for (std::size_t i = 0; i < fit.probability.size(); ++i) sorted.probability[i][k] = fit.probability[i][order[k]];
  }
  fit = std::move(sorted);
}

}  // namespace

MixtureFit fit_mixture(const LikelihoodSurface& surface, std::size_t num_types, const PopulationLimits& limits) {
  if (num_types == 0 || num_types > surface.num_people()) {
    throw std::invalid_argument{"fit_mixture: there must be 1 to as many types as people"};
  }
  auto fit = detail::fit_weighted_mixture(surface, num_types, limits, std::vector<double>(surface.num_people(), 1.0));
  sort_types(fit);
  return fit;
}

}  // namespace kith
