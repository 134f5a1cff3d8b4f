#include "kith/belief/particle_belief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "kernels.hpp"
#include "kith/core/error.hpp"
#include "kith/random/distributions.hpp"
#include "systematic.hpp"

namespace kith {
namespace {

FilterOptions checked(const FilterOptions& options) {
  if (options.particles == 0) throw std::invalid_argument("FilterOptions: particles must be at least 1");
  if (!(options.process_noise >= 0.0 && std::isfinite(options.process_noise))) {
    throw std::invalid_argument("FilterOptions: process_noise must be finite and not negative");
  }
  if (!(options.resample_below >= 0.0 && options.resample_below <= 1.0)) {
    throw std::invalid_argument("FilterOptions: resample_below must lie in [0, 1]");
  }
  return options;
}

// Whether both sides are equally likely (ability 1/2): such evidence says nothing.
bool is_constant(const HalfSpaceLikelihood& likelihood) {
  return likelihood.concentration() == 0.0 && likelihood.log_far() == 0.0;
}

}  // namespace

ParticleBelief::ParticleBelief(const Cone& prior, const FilterOptions& options)
    : ParticleBelief{PriorCover{prior, checked(options).particles}, options} {}

ParticleBelief::ParticleBelief(const PriorCover& cover, const FilterOptions& options)
    : options_{checked(options)},
      prior_normals_{cover.normals()},
      x_{cover.x()},
      y_{cover.y()},
      z_{cover.z()},
      log_weights_(cover.size(), 0.0),
      weights_(cover.size(), 1.0 / static_cast<double>(cover.size())),
      log_sum_{std::log(static_cast<double>(cover.size()))} {
  if (cover.size() != options.particles) {
    throw std::invalid_argument("ParticleBelief: the cover must have as many points as the belief has particles");
  }
}

void ParticleBelief::observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                             RandomStream random) {
  if (half_spaces.empty() || is_constant(likelihood)) return;
  std::vector<double> factors(size());
  detail::log_relative_products({x_, y_, z_}, detail::planes_of(half_spaces, likelihood), factors);
  reweigh(std::move(factors), random);
}

void ParticleBelief::observe_any(std::span<const std::vector<HalfSpace>> alternatives,
                                 const HalfSpaceLikelihood& likelihood, RandomStream random) {
  const bool fits_everywhere =
      std::any_of(alternatives.begin(), alternatives.end(), [](const auto& list) { return list.empty(); });
  if (alternatives.empty() || fits_everywhere || is_constant(likelihood)) return;
  std::vector<double> best(size());
  std::vector<double> factors(size());
  for (std::size_t a = 0; a < alternatives.size(); ++a) {
    detail::log_relative_products({x_, y_, z_}, detail::planes_of(alternatives[a], likelihood),
                                  a == 0 ? best : factors);
    if (a == 0) continue;
    detail::raise(factors, best);
  }
  reweigh(std::move(best), random);
}

// `factors` becomes the new log weights; nothing else changes before it is sure that some particle remains.
void ParticleBelief::reweigh(std::vector<double> factors, RandomStream random) {
  detail::add(log_weights_, factors);
  const double top = detail::largest(factors);
  if (!(top > -std::numeric_limits<double>::infinity())) {
    throw Error{ErrorKind::kInfeasible,
                "the half-spaces exclude every particle of the belief, and learning ability 1 leaves no doubt"};
  }
  for (double& factor : factors) factor -= top;
  log_weights_.swap(factors);
  normalise();
  if (effective_sample_size() < options_.resample_below * static_cast<double>(size())) resample(random);
}

void ParticleBelief::normalise() {
  const double sum = detail::exp_below(log_weights_, 0.0, weights_);
  log_sum_ = std::log(sum);
  const double scale = 1.0 / sum;
  for (double& weight : weights_) weight *= scale;
}

void ParticleBelief::resample(RandomStream& random) {
  const auto count = static_cast<double>(size());
  const double angle =
      options_.process_noise > 0.0 ? options_.process_noise * spread() * std::pow(count, -1.0 / 6.0) : 0.0;
  const auto index = detail::systematic_indices(weights_, size(), uniform01(random));
  std::vector<double> drawn(size());
  for (auto* axis : {&x_, &y_, &z_}) {
    detail::gather(*axis, index, drawn);
    axis->swap(drawn);
  }
  std::fill(log_weights_.begin(), log_weights_.end(), 0.0);
  std::fill(weights_.begin(), weights_.end(), 1.0 / count);
  log_sum_ = std::log(count);
  ++num_resamplings_;
  if (angle > 0.0) detail::move_points({x_, y_, z_}, angle, prior_normals_, random);
}

void ParticleBelief::diffuse(double angle, RandomStream random) {
  if (!(angle >= 0.0 && std::isfinite(angle))) {
    throw std::invalid_argument("ParticleBelief::diffuse: the angle must be finite and not negative");
  }
  if (angle > 0.0) detail::move_points({x_, y_, z_}, angle, prior_normals_, random);
}

double ParticleBelief::mass_in(std::span<const HalfSpace> half_spaces) const {
  if (half_spaces.empty()) return 1.0;
  return std::min(1.0, detail::weight_inside({x_, y_, z_}, weights_, half_spaces));
}

double ParticleBelief::log_evidence(std::span<const HalfSpace> half_spaces,
                                    const HalfSpaceLikelihood& likelihood) const {
  const double near = static_cast<double>(half_spaces.size()) * likelihood.log_density(0.0);
  std::vector<double> factors(size());
  detail::log_relative_products({x_, y_, z_}, detail::planes_of(half_spaces, likelihood), factors);
  detail::add(log_weights_, factors);
  const double top = detail::largest(factors);
  if (!(top > -std::numeric_limits<double>::infinity())) return top;
  const double sum = detail::exp_below(factors, top, factors);
  return near + (top + std::log(sum) - log_sum_);
}

double ParticleBelief::effective_sample_size() const noexcept {
  return std::clamp(1.0 / detail::sum_of_squares(weights_), 1.0, static_cast<double>(size()));
}

Eigen::Vector3d ParticleBelief::mean_direction() const {
  const Eigen::Vector3d mean = detail::weighted_sum({x_, y_, z_}, weights_);
  const double length = mean.norm();
  if (length < 1e-12) return point(0);
  return mean / length;
}

double ParticleBelief::spread() const {
  return std::sqrt(detail::weighted_square_angles({x_, y_, z_}, weights_, mean_direction()));
}

std::vector<ParticleBelief::Draw> ParticleBelief::systematic_draws(std::size_t n, RandomStream random) const {
  const auto counts = systematic_counts(weights_, n, uniform01(random));
  std::vector<Draw> draws;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) draws.push_back({i, counts[i]});
  }
  return draws;
}

}  // namespace kith
