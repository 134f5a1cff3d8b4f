#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kith/core/distributions.hpp"
#include "mixture.hpp"

namespace kith {
namespace {

using detail::fit_weighted_mixture;
using detail::log_sum;

// The log density of every person under a model that is fitted to the people with weight 1.
using Predict = std::function<std::vector<double>(const std::vector<double>& training)>;

std::vector<double> densities(const LikelihoodSurface& surface, const PopulationFit& fit,
                              const PopulationLimits& limits) {
  const auto masses = masses_of(surface, fit.parameters, limits, fit.gains);
  std::vector<double> result;
  for (std::size_t i = 0; i < surface.num_people(); ++i) result.push_back(log_marginal(surface, i, masses));
  return result;
}

Predict one_population(const LikelihoodSurface& surface, const PopulationLimits& limits, GainModel gains) {
  return [&surface, limits, gains](const std::vector<double>& training) {
    return densities(surface, fit_population(surface, training, limits, gains), limits);
  };
}

Predict two_types(const LikelihoodSurface& surface, const PopulationLimits& limits) {
  return [&surface, limits](const std::vector<double>& training) {
    const auto fit = fit_weighted_mixture(surface, 2, limits, training);
    const auto first = densities(surface, fit.types[0], limits);
    const auto second = densities(surface, fit.types[1], limits);
    std::vector<double> result;
    for (std::size_t i = 0; i < first.size(); ++i) {
      result.push_back(log_sum({std::log(fit.shares[0]) + first[i], std::log(fit.shares[1]) + second[i]}));
    }
    return result;
  };
}

Predict labelled_types(const LikelihoodSurface& surface, const PopulationLimits& limits,
                       const std::vector<std::string>& labels) {
  return [&surface, limits, labels](const std::vector<double>& training) {
    std::vector<double> result(labels.size(), 0.0);
    auto names = labels;
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const auto& name : names) {
      auto weights = training;
      for (std::size_t i = 0; i < labels.size(); ++i) weights[i] *= labels[i] == name ? 1.0 : 0.0;
      const auto values = densities(surface, fit_population(surface, weights, limits, GainModel::kFree), limits);
      for (std::size_t i = 0; i < labels.size(); ++i) result[i] = labels[i] == name ? values[i] : result[i];
    }
    return result;
  };
}

// Which fold everybody is in.
std::vector<std::size_t> folds_of(std::size_t people, std::size_t folds, std::uint64_t seed) {
  std::vector<std::size_t> order(people);
  std::iota(order.begin(), order.end(), std::size_t{0});
  auto random = RandomStream{seed}.split("folds");
  for (std::size_t i = people; i > 1; --i) std::swap(order[i - 1], order[uniform_index(i, random)]);
  std::vector<std::size_t> fold(people);
  for (std::size_t i = 0; i < people; ++i) fold[order[i]] = i % folds;
  return fold;
}

bool labels_can_be_compared(const std::vector<std::string>& labels, const std::vector<std::size_t>& fold,
                            std::size_t folds) {
  auto names = labels;
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  if (names.size() < 2 || names.front().empty()) return false;
  for (const auto& name : names) {
    for (std::size_t f = 0; f < folds; ++f) {
      std::size_t trained = 0;
      for (std::size_t i = 0; i < labels.size(); ++i) trained += labels[i] == name && fold[i] != f ? 1u : 0u;
      if (trained < 2) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<CrossValidation> cross_validate(const LikelihoodSurface& surface, const std::vector<std::string>& labels,
                                            const PopulationLimits& limits, std::size_t folds, std::uint64_t seed,
                                            const ParallelOptions& parallel) {
  const auto people = surface.num_people();
  if (folds < 2 || folds > people) throw std::invalid_argument{"cross_validate: 2 <= folds <= people must hold"};
  const auto fold = folds_of(people, folds, seed);
  std::vector<std::pair<std::string, Predict>> models{
      {"full", one_population(surface, limits, GainModel::kFree)},
      {"equal gains", one_population(surface, limits, GainModel::kEqual)},
      {"no gains", one_population(surface, limits, GainModel::kNone)}};
  if (people / folds >= 4) models.emplace_back("two types", two_types(surface, limits));
  if (labels_can_be_compared(labels, fold, folds)) {
    models.emplace_back("types as labelled", labelled_types(surface, limits, labels));
  }
  std::vector<std::vector<double>> density(models.size(), std::vector<double>(people, 0.0));
  std::vector<std::vector<double>> parts(models.size() * folds);
  for_each_index(parts.size(), parallel, [&](std::size_t task) {
    std::vector<double> training(people);
    for (std::size_t i = 0; i < people; ++i) training[i] = fold[i] == task % folds ? 0.0 : 1.0;
    parts[task] = models[task / folds].second(training);
  });
  for (std::size_t task = 0; task < parts.size(); ++task) {
    for (std::size_t i = 0; i < people; ++i) {
      if (fold[i] == task % folds && !parts[task].empty()) density[task / folds][i] = parts[task][i];
    }
  }
  std::vector<CrossValidation> result;
  for (std::size_t m = 0; m < models.size(); ++m) {
    CrossValidation one{.model = models[m].first};
    double square = 0.0;
    for (std::size_t i = 0; i < people; ++i) {
      one.log_density += density[m][i];
      one.difference += density[m][i] - density[0][i];
    }
    const double mean = one.difference / static_cast<double>(people);
    for (std::size_t i = 0; i < people; ++i) square += std::pow(density[m][i] - density[0][i] - mean, 2);
    one.difference_se = std::sqrt(square * static_cast<double>(people) / static_cast<double>(people - 1));
    result.push_back(one);
  }
  return result;
}

}  // namespace kith
