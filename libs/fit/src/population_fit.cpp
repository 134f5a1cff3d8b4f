#include "kith/fit/population_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kith/analysis/distributions.hpp"
#include "kith/core/distributions.hpp"
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
const std::array<Bounds, kNumParameters> kBounds{{
    {kSmallestPopulation.ability_mean / kMeanUnit, kLargestPopulation.ability_mean / kMeanUnit},
    {std::log(kSmallestPopulation.ability_sd), std::log(kLargestPopulation.ability_sd)},
    {std::log(kSmallestPopulation.confirm_scale), std::log(kLargestPopulation.confirm_scale)},
    {std::log(kSmallestPopulation.correct_scale), std::log(kLargestPopulation.correct_scale)},
}};

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
    double outside = 0.0;
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

}  // namespace kith
