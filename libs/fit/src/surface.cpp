// Likelihoods on a refined grid, the prior masses of its cells, and what follows for one person.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "kith/fit/population_fit.hpp"

namespace kith {
namespace {

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

void normalise(std::vector<double>& masses) {
  double sum = 0.0;
  for (const double mass : masses) sum += mass;
  if (sum > 0.0) {
    for (double& mass : masses) mass /= sum;
    return;
  }
  for (double& mass : masses) mass = 1.0 / static_cast<double>(masses.size());
}

// Mass of N(mean, sd^2) within a cell of the grid, as far as it is allowed.
std::vector<double> ability_masses(const LikelihoodSurface& surface, const PopulationParameters& population,
                                   const PopulationLimits& limits) {
  const double half = 0.5 * surface.ability_step();
  std::vector<double> masses;
  for (const double ability : surface.abilities()) {
    const double from = std::max(ability - half, limits.ability_min);
    const double to = std::min(ability + half, limits.ability_max);
    const double z_from = (from - population.ability_mean) / population.ability_sd;
    const double z_to = (to - population.ability_mean) / population.ability_sd;
    masses.push_back(from < to ? normal_cdf(z_to) - normal_cdf(z_from) : 0.0);
  }
  normalise(masses);
  return masses;
}

// Mass of a half-normal within a cell of the gains.
std::vector<double> gain_masses(const LikelihoodSurface& surface, double scale, const PopulationLimits& limits) {
  const double half = 0.5 * surface.gain_step();
  std::vector<double> masses;
  for (const double gain : surface.gains()) {
    const double from = std::max(gain - half, 0.0);
    const double to = std::min(gain + half, limits.gain_max);
    masses.push_back(from < to ? 2.0 * (normal_cdf(to / scale) - normal_cdf(from / scale)) : 0.0);
  }
  normalise(masses);
  return masses;
}

std::vector<double> gain_pair_masses(const LikelihoodSurface& surface, const PopulationParameters& population,
                                     const PopulationLimits& limits, GainModel model) {
  const auto n = surface.gains().size();
  std::vector<double> pairs(n * n, 0.0);
  if (model == GainModel::kNone) {
    pairs[0] = 1.0;
    return pairs;
  }
  const auto correct = gain_masses(surface, population.correct_scale, limits);
  const auto confirm = gain_masses(surface, population.confirm_scale, limits);
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      if (model == GainModel::kEqual) {
        pairs[c * n + i] = c == i ? correct[i] : 0.0;
      } else {
        // In a cell on the diagonal half of the pairs are ordered.
        const double allowed = !limits.ordered_gains || c < i ? 1.0 : c == i ? 0.5 : 0.0;
        pairs[c * n + i] = allowed * confirm[c] * correct[i];
      }
    }
  }
  normalise(pairs);
  return pairs;
}

// A distribution on equally wide cells about some values.
struct Marginal {
  const std::vector<double>& values;
  std::vector<double> masses;
  double least;  // the first cell may begin here

  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += masses[i] * values[i];
    return sum;
  }
  [[nodiscard]] double sd() const {
    const double centre = mean();
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += masses[i] * (values[i] - centre) * (values[i] - centre);
    return std::sqrt(sum);
  }
  // Uniform within cells.
  [[nodiscard]] double quantile(double p) const {
    const double half = 0.5 * (values[1] - values[0]);
    double below = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (below + masses[i] >= p && masses[i] > 0.0) {
        const double from = std::max(values[i] - half, least);
        return from + (values[i] + half - from) * (p - below) / masses[i];
      }
      below += masses[i];
    }
    return values.back() + half;
  }
};

ParameterPosterior describe(const Marginal& posterior, const Marginal& prior) {
  return {posterior.mean(), posterior.sd(), posterior.quantile(0.025), posterior.quantile(0.975), prior.sd()};
}

// The marginals of a distribution over the cells of a surface.
class CellDistribution {
 public:
  CellDistribution(const LikelihoodSurface& surface, const std::vector<double>& masses)
      : surface_{surface},
        ability_(surface.abilities().size(), 0.0),
        confirm_(surface.gains().size(), 0.0),
        correct_(surface.gains().size(), 0.0) {
    const auto n = surface.gains().size();
    for (std::size_t i = 0; i < masses.size(); ++i) {
      ability_[i / (n * n)] += masses[i];
      confirm_[i / n % n] += masses[i];
      correct_[i % n] += masses[i];
      product_ += masses[i] * surface.gains()[i / n % n] * surface.gains()[i % n];
    }
  }

  [[nodiscard]] Marginal ability() const { return {surface_.abilities(), ability_, 0.5}; }
  [[nodiscard]] Marginal confirm() const { return {surface_.gains(), confirm_, 0.0}; }
  [[nodiscard]] Marginal correct() const { return {surface_.gains(), correct_, 0.0}; }
  [[nodiscard]] double covariance() const { return product_ - confirm().mean() * correct().mean(); }
  [[nodiscard]] double difference_sd() const {
    const double variance = std::pow(confirm().sd(), 2) + std::pow(correct().sd(), 2) - 2.0 * covariance();
    return std::sqrt(std::max(variance, 0.0));
  }
  [[nodiscard]] double correlation() const {
    const double scale = confirm().sd() * correct().sd();
    return scale > 1e-12 ? covariance() / scale : 0.0;
  }

 private:
  const LikelihoodSurface& surface_;
  std::vector<double> ability_;
  std::vector<double> confirm_;
  std::vector<double> correct_;
  double product_ = 0.0;
};

PersonPosterior compare(const CellDistribution& posterior, const CellDistribution& prior) {
  PersonPosterior result;
  result.ability = describe(posterior.ability(), prior.ability());
  result.confirm_gain = describe(posterior.confirm(), prior.confirm());
  result.correct_gain = describe(posterior.correct(), prior.correct());
  result.difference.mean = result.correct_gain.mean - result.confirm_gain.mean;
  result.difference.sd = posterior.difference_sd();
  result.difference.prior_sd = prior.difference_sd();
  result.gain_correlation = posterior.correlation();
  return result;
}

}  // namespace

namespace {

std::vector<double> refined(const std::vector<double>& coarse, std::size_t refine) {
  std::vector<double> values;
  const auto n = (coarse.size() - 1) * refine + 1;
  const double step = (coarse.back() - coarse.front()) / static_cast<double>(n - 1);
  for (std::size_t i = 0; i < n; ++i) values.push_back(coarse.front() + step * static_cast<double>(i));
  return values;
}

// Cubic interpolation between the second and the third of four equally spaced values [catmull1974].
double cubic(double before, double left, double right, double after, double t) {
  const double slope = 0.5 * (right - before);
  const double end_slope = 0.5 * (after - left);
  const double rise = right - left;
  return left + t * (slope + t * (3.0 * rise - 2.0 * slope - end_slope + t * (slope + end_slope - 2.0 * rise)));
}

// A table of shape [outer, n, inner] with refine times as many steps along its middle axis. Not linear between points:
// that would put a small peak on every point, and populations would gather there.
std::vector<double> refined_axis(const std::vector<double>& values, std::size_t outer, std::size_t n, std::size_t inner,
                                 std::size_t refine) {
  const auto fine = (n - 1) * refine + 1;
  std::vector<double> result(outer * fine * inner);
  for (std::size_t o = 0; o < outer; ++o) {
    for (std::size_t k = 0; k < inner; ++k) {
      const auto at = [&](std::size_t i) { return values[(o * n + i) * inner + k]; };
      for (std::size_t i = 0; i < fine; ++i) {
        const auto left = std::min(i / refine, n - 2);
        const double t = static_cast<double>(i - left * refine) / static_cast<double>(refine);
        // Beyond an end the parabola through the last three points goes on; two points have a straight line only.
        const double before = left > 0 ? at(left - 1) : n > 2 ? 3.0 * at(0) - 3.0 * at(1) + at(2) : 2.0 * at(0) - at(1);
        const double after = left + 2 < n ? at(left + 2)
                             : n > 2      ? 3.0 * at(n - 1) - 3.0 * at(n - 2) + at(n - 3)
                                          : 2.0 * at(1) - at(0);
        result[(o * fine + i) * inner + k] = cubic(before, at(left), at(left + 1), after, t);
      }
    }
  }
  return result;
}

}  // namespace

LikelihoodSurface::LikelihoodSurface(const LikelihoodTable& table, std::size_t refine) {
  if (!table.complete || table.log_likelihood.empty() || refine == 0) {
    throw std::invalid_argument{"LikelihoodSurface: a complete table with people is needed, and refine >= 1"};
  }
  constexpr std::size_t kRefineGains = 2;
  const auto num_abilities = table.grid.abilities.size();
  const auto n = table.grid.confirm_gains.size();
  abilities_ = refined(table.grid.abilities, refine);
  gains_ = refined(table.grid.confirm_gains, kRefineGains);
  for (const auto& row : table.log_likelihood) {
    auto values = refined_axis(row, num_abilities * n, n, 1, kRefineGains);
    values = refined_axis(values, num_abilities, n, gains_.size(), kRefineGains);
    values = refined_axis(values, 1, num_abilities, gains_.size() * gains_.size(), refine);
    const double top = *std::max_element(values.begin(), values.end());
    for (double& value : values) value = std::exp(value - top);
    relative_.push_back(std::move(values));
    log_top_.push_back(top);
  }
}

PopulationMasses masses_of(const LikelihoodSurface& surface, const PopulationParameters& population,
                           const PopulationLimits& limits, GainModel gains) {
  return {ability_masses(surface, population, limits), gain_pair_masses(surface, population, limits, gains)};
}

double log_marginal(const LikelihoodSurface& surface, std::size_t person, const PopulationMasses& masses) {
  constexpr double kNegligible = 1e-14;
  const auto& likelihood = surface.relative(person);
  const auto num_pairs = masses.gains.size();
  // Summed pair by pair first: a loop that the compiler can vectorise.
  std::vector<double> of_pair(num_pairs, 0.0);
  double* const sums = of_pair.data();
  for (std::size_t a = 0; a < masses.abilities.size(); ++a) {
    const double mass = masses.abilities[a];
    if (mass < kNegligible) continue;
    const double* const row = likelihood.data() + a * num_pairs;
    for (std::size_t g = 0; g < num_pairs; ++g) sums[g] += mass * row[g];
  }
  double sum = 0.0;
  for (std::size_t g = 0; g < num_pairs; ++g) sum += sums[g] * masses.gains[g];
  return surface.log_top(person) + std::log(std::max(sum, 1e-300));
}

PersonPosterior posterior_of(const LikelihoodSurface& surface, std::size_t person, const PopulationMasses& masses) {
  return posterior_of(surface, person, {masses}, {1.0});
}

PersonPosterior posterior_of(const LikelihoodSurface& surface, std::size_t person,
                             const std::vector<PopulationMasses>& masses, const std::vector<double>& probabilities) {
  const auto& likelihood = surface.relative(person);
  std::vector<double> posterior(likelihood.size(), 0.0);
  std::vector<double> prior(likelihood.size(), 0.0);
  for (std::size_t k = 0; k < masses.size(); ++k) {
    const auto num_pairs = masses[k].gains.size();
    const double evidence = std::exp(log_marginal(surface, person, masses[k]) - surface.log_top(person));
    for (std::size_t i = 0; i < prior.size(); ++i) {
      const double mass = masses[k].abilities[i / num_pairs] * masses[k].gains[i % num_pairs];
      prior[i] += probabilities[k] * mass;
      posterior[i] += probabilities[k] * mass * likelihood[i] / evidence;
    }
  }
  normalise(posterior);
  return compare({surface, posterior}, {surface, prior});
}

}  // namespace kith
