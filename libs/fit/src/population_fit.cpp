#include "kith/fit/population_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kith/random/distributions.hpp"
#include "kith/stats/distributions.hpp"
#include "nelder_mead.hpp"

namespace kith {
namespace {

// The parameters as the search moves them: mean, log sd, log scales. All of about the same size, within bounds.
constexpr std::size_t kNumParameters = 4;
using Point = std::array<double, kNumParameters>;
struct Bounds {
  double lower;
  double upper;
};
constexpr double kMeanUnit = 0.1;  // one unit of the search is this much of the mean
const std::array<Bounds, kNumParameters> kBounds{{{0.5 / kMeanUnit, 1.0 / kMeanUnit},
                                                  {std::log(0.003), std::log(0.3)},
                                                  {std::log(0.001), std::log(0.5)},
                                                  {std::log(0.001), std::log(0.5)}}};

Point to_point(const PopulationParameters& p) {
  return {p.ability_mean / kMeanUnit, std::log(p.ability_sd), std::log(p.confirm_scale), std::log(p.correct_scale)};
}

PopulationParameters to_parameters(const Point& x) {
  return {x[0] * kMeanUnit, std::exp(x[1]), std::exp(x[2]), std::exp(x[3])};
}

// A likelihood to be maximised over some of the parameters.
class Problem {
 public:
  Problem(const LikelihoodSurface& surface, std::vector<double> weights, const PopulationLimits& limits,
          GainModel gains)
      : surface_{surface}, weights_{std::move(weights)}, limits_{limits}, gains_{gains} {
    if (weights_.empty()) weights_.assign(surface.num_people(), 1.0);
    if (weights_.size() != surface.num_people()) {
      throw std::invalid_argument{"fit_population: there must be one weight per person"};
    }
    free_ = {0, 1};
    if (gains == GainModel::kFree) free_ = {0, 1, 2, 3};
    if (gains == GainModel::kEqual) free_ = {0, 1, 3};
  }

  // One scale for both gains, the correct one.
  void tie_scales() {
    tied_ = true;
    std::erase(free_, std::size_t{2});
  }

  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }
  [[nodiscard]] double total_weight() const { return std::accumulate(weights_.begin(), weights_.end(), 0.0); }

  [[nodiscard]] double log_likelihood(Point x) const {
    if (tied_ || gains_ == GainModel::kEqual) x[2] = x[3];
    const auto masses = masses_of(surface_, to_parameters(x), limits_, gains_);
    double sum = 0.0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (weights_[i] > 0.0) sum += weights_[i] * log_marginal(surface_, i, masses);
    }
    return sum;
  }

  struct Best {
    Point x;
    double log_likelihood;
  };

  // The best point with the parameters that are not searched as they are in `start`.
  [[nodiscard]] Best maximise(const Point& start, const std::vector<std::size_t>& searched, double step) const {
    const auto at = [&](const std::vector<double>& values) {
      auto x = start;
      for (std::size_t k = 0; k < searched.size(); ++k) x[searched[k]] = values[k];
      return x;
    };
    // Outside the bounds the value at the nearest point inside, and a slope back.
    const auto cost = [&](const std::vector<double>& values) {
      auto x = at(values);
      double outside = 0.0;
      for (const auto k : searched) {
        const double inside = std::clamp(x[k], kBounds[k].lower, kBounds[k].upper);
        outside += std::abs(x[k] - inside);
        x[k] = inside;
      }
      return outside - log_likelihood(x);
    };
    std::vector<double> values;
    for (const auto k : searched) values.push_back(start[k]);
    const auto minimum = detail::nelder_mead(cost, values, step);
    auto x = at(minimum.x);
    for (const auto k : searched) x[k] = std::clamp(x[k], kBounds[k].lower, kBounds[k].upper);
    return {x, log_likelihood(x)};
  }

  [[nodiscard]] Best maximise(const Point& start) const {
    const auto first = maximise(start, free_, 0.4);
    return maximise(first.x, free_, 0.15);
  }

  // How far parameter k can go from the best point until twice the log-likelihood has dropped by 3.84.
  [[nodiscard]] FitInterval profile(const Best& best, std::size_t k) const {
    FitInterval interval;
    std::tie(interval.lower, interval.lower_open) = limit(best, k, kBounds[k].lower);
    std::tie(interval.upper, interval.upper_open) = limit(best, k, kBounds[k].upper);
    return interval;
  }

 private:
  [[nodiscard]] std::pair<double, bool> limit(const Best& best, std::size_t k, double edge) const {
    constexpr double kDrop = 0.5 * 3.841458820694124;
    std::vector<std::size_t> others;
    std::copy_if(free_.begin(), free_.end(), std::back_inserter(others), [&](std::size_t j) { return j != k; });
    auto warm = best.x;
    const auto loss = [&](double value) {
      warm[k] = value;
      const auto found = maximise(warm, others, 0.1);
      warm = found.x;
      return best.log_likelihood - found.log_likelihood;
    };
    // Step outwards first: the edge is far, and the search near the best point is easy.
    double inside = best.x[k];
    double step = edge > inside ? 0.1 : -0.1;
    double outside = inside;
    while (true) {
      outside = edge > inside ? std::min(inside + step, edge) : std::max(inside + step, edge);
      if (loss(outside) > kDrop) break;
      if (outside == edge) return {edge, true};
      inside = outside;
      step *= 1.6;
    }
    for (int round = 0; round < 7; ++round) {
      const double middle = 0.5 * (inside + outside);
      (loss(middle) > kDrop ? outside : inside) = middle;
    }
    return {0.5 * (inside + outside), false};
  }

  const LikelihoodSurface& surface_;
  std::vector<double> weights_;
  PopulationLimits limits_;
  GainModel gains_;
  std::vector<std::size_t> free_;
  bool tied_ = false;
};

PopulationFit to_fit(const Problem& problem, Problem::Best best, GainModel gains) {
  if (gains == GainModel::kEqual) best.x[2] = best.x[3];
  PopulationFit fit;
  fit.parameters = to_parameters(best.x);
  if (gains == GainModel::kNone) fit.parameters.confirm_scale = fit.parameters.correct_scale = 0.0;
  fit.gains = gains;
  fit.log_likelihood = best.log_likelihood;
  fit.people = problem.total_weight();
  return fit;
}

FitInterval exponential(FitInterval interval) {
  interval.lower = std::exp(interval.lower);
  interval.upper = std::exp(interval.upper);
  return interval;
}

}  // namespace

PopulationFit fit_population(const LikelihoodSurface& surface, const std::vector<double>& weights,
                             const PopulationLimits& limits, GainModel gains, const PopulationParameters& start) {
  const Problem problem{surface, weights, limits, gains};
  return to_fit(problem, problem.maximise(to_point(start)), gains);
}

PopulationFit fit_with_intervals(const LikelihoodSurface& surface, const std::vector<double>& weights,
                                 const PopulationLimits& limits, GainModel gains) {
  const Problem problem{surface, weights, limits, gains};
  const auto best = problem.maximise(to_point({}));
  auto fit = to_fit(problem, best, gains);
  fit.ability_mean = problem.profile(best, 0);
  fit.ability_mean.lower *= kMeanUnit;
  fit.ability_mean.upper *= kMeanUnit;
  fit.ability_sd = exponential(problem.profile(best, 1));
  if (gains == GainModel::kNone) return fit;
  fit.correct_scale = exponential(problem.profile(best, 3));
  fit.confirm_scale = gains == GainModel::kEqual ? fit.correct_scale : exponential(problem.profile(best, 2));
  return fit;
}

namespace {

// log of the priors of draw_populations(), as densities of the parameters that the walk moves.
double log_hyperprior(const Point& x) {
  constexpr double kScale = 0.1;
  double sum = 0.0;
  for (std::size_t k = 0; k < kNumParameters; ++k) {
    if (x[k] < kBounds[k].lower || x[k] > kBounds[k].upper) return -std::numeric_limits<double>::infinity();
    if (k == 0) continue;
    const double value = std::exp(x[k]);
    sum += x[k] - 0.5 * (value / kScale) * (value / kScale);  // x[k]: of the change from value to its logarithm
  }
  return sum;
}

}  // namespace

std::vector<PopulationParameters> draw_populations(const LikelihoodSurface& surface, const std::vector<double>& weights,
                                                   const PopulationLimits& limits, const PopulationFit& start,
                                                   std::size_t num_draws, RandomStream random) {
  const Problem problem{surface, weights, limits, GainModel::kFree};
  constexpr std::size_t kBetween = 40;
  constexpr std::array<double, kNumParameters> kSteps{0.2, 0.35, 0.7, 0.7};
  auto x = to_point(start.parameters);
  for (std::size_t k = 1; k < kNumParameters; ++k) x[k] = std::clamp(x[k], std::log(0.01), std::log(0.15));
  const auto log_posterior = [&](const Point& at) {
    const double prior = log_hyperprior(at);
    return std::isfinite(prior) ? prior + problem.log_likelihood(at) : prior;
  };
  double here = log_posterior(x);
  std::vector<PopulationParameters> draws;
  const std::size_t burn_in = 10 * kBetween;
  for (std::size_t round = 0; round < burn_in + num_draws * kBetween; ++round) {
    auto next = x;
    for (std::size_t k = 0; k < kNumParameters; ++k) next[k] += kSteps[k] * standard_normal(random);
    const double there = log_posterior(next);
    if (std::log(std::max(uniform01(random), 1e-300)) < there - here) {
      x = next;
      here = there;
    }
    if (round >= burn_in && (round - burn_in + 1) % kBetween == 0) draws.push_back(to_parameters(x));
  }
  return draws;
}

GainsTest compare_gain_scales(const LikelihoodSurface& surface, const std::vector<double>& weights,
                              PopulationLimits limits) {
  limits.ordered_gains = false;
  const Problem free{surface, weights, limits, GainModel::kFree};
  Problem tied{surface, weights, limits, GainModel::kFree};
  tied.tie_scales();
  const auto common = tied.maximise(to_point({}));
  auto from = common.x;
  from[2] = from[3];
  const double best = std::max(free.maximise(from).log_likelihood, free.maximise(to_point({})).log_likelihood);
  GainsTest test;
  test.statistic = std::max(0.0, 2.0 * (best - common.log_likelihood));
  test.p = chi_squared_upper(test.statistic, 1.0);
  return test;
}

namespace {

double log_sum(const std::vector<double>& logs) {
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double x : logs) sum += std::exp(x - top);
  return top + std::log(sum);
}

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

MixtureFit fit_weighted_mixture(const LikelihoodSurface& surface, std::size_t num_types, const PopulationLimits& limits,
                                const std::vector<double>& weights) {
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

MixtureFit fit_mixture(const LikelihoodSurface& surface, std::size_t num_types, const PopulationLimits& limits) {
  if (num_types == 0 || num_types > surface.num_people()) {
    throw std::invalid_argument{"fit_mixture: there must be 1 to as many types as people"};
  }
  auto fit = fit_weighted_mixture(surface, num_types, limits, std::vector<double>(surface.num_people(), 1.0));
  sort_types(fit);
  return fit;
}

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
