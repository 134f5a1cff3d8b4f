#include "kith/belief/particle_belief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "kernels.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/core/math.hpp"
#include "scratch.hpp"
#include "sphere_points.hpp"
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
      dimension_{cover.dimension()},
      prior_normals_{cover.normals()},
      points_{cover.points()},
      log_weights_(cover.size(), 0.0),
      weights_(cover.size(), 1.0 / static_cast<double>(cover.size())),
      log_sum_{math::log(static_cast<double>(cover.size()))},
      least_support_{static_cast<double>(cover.size())},
      product_{dimension_ > 3 && options.process_noise > 0.0} {
  if (cover.size() != options.particles) {
    throw std::invalid_argument("ParticleBelief: the cover must have as many points as the belief has particles");
  }
  if (!cover.weights().empty()) weigh_by(cover.weights());
}

void ParticleBelief::check(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood) const {
  const bool fit = std::all_of(half_spaces.begin(), half_spaces.end(),
                               [&](const HalfSpace& h) { return h.dimension() == dimension_; });
  if (!fit || likelihood.dimension() != dimension_) {
    throw std::invalid_argument("ParticleBelief: half-spaces and likelihood must have the belief's dimension");
  }
}

void ParticleBelief::weigh(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                           std::span<double> factors) const {
  detail::SpherePoints{points_, dimension_}.log_relative_products(half_spaces, likelihood, factors);
}

void ParticleBelief::observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                             RandomStream random) {
  check(half_spaces, likelihood);
  if (half_spaces.empty() || is_constant(likelihood)) return;
  detail::ParticleScratch<double> factors{size()};
  weigh(half_spaces, likelihood, factors.values());
  if (!product_.is_kept()) return reweigh_and_record(factors.values(), random);
  observe_in_product(half_spaces, likelihood, factors.values(), random);
}

void ParticleBelief::observe_any(std::span<const std::vector<HalfSpace>> alternatives,
                                 const HalfSpaceLikelihood& likelihood, RandomStream random) {
  for (const auto& alternative : alternatives) check(alternative, likelihood);
  const bool fits_everywhere =
      std::any_of(alternatives.begin(), alternatives.end(), [](const auto& list) { return list.empty(); });
  if (alternatives.empty() || fits_everywhere || is_constant(likelihood)) return;
  detail::ParticleScratch<double> best{size()};
  detail::ParticleScratch<double> factors{size()};
  weigh(alternatives[0], likelihood, best.values());
  for (const auto& alternative : alternatives.subspan(1)) {
    weigh(alternative, likelihood, factors.values());
    detail::raise(factors.values(), best.values());
  }
  auto product = std::exchange(product_, detail::LikelihoodProduct{false});
  try {
    reweigh_and_record(best.values(), random);
  } catch (...) {
    product_ = std::move(product);
    throw;
  }
}

// The effective number of points that satisfy all half-spaces: their factor is exactly 1, and its logarithm 0. Where
// all do, no point has lost any weight.
double ParticleBelief::support(std::span<const double> log_factors) const noexcept {
  if (std::all_of(log_factors.begin(), log_factors.end(), [](double f) { return f == 0.0; })) {
    return static_cast<double>(size());
  }
  double sum = 0.0, sum_of_squares = 0.0;
  for (std::size_t i = 0; i < log_factors.size(); ++i) {
    const double weight = log_factors[i] == 0.0 ? weights_[i] : 0.0;
    sum += weight;
    sum_of_squares += weight * weight;
  }
  return sum_of_squares > 0.0 ? sum * sum / sum_of_squares : 0.0;
}

void ParticleBelief::reweigh_and_record(std::span<double> factors, RandomStream random) {
  if (!options_.records_support) return reweigh(factors, random);
  const double fitting = support(factors);
  reweigh(factors, random);
  least_support_ = std::min(least_support_, fitting);
}

// `factors` becomes the new log weights; nothing else changes before it is sure that some particle remains.
void ParticleBelief::reweigh(std::span<double> factors, RandomStream random) {
  const double top = detail::add(log_weights_, factors);
  if (!(top > -std::numeric_limits<double>::infinity())) {
    throw Error{ErrorKind::kInfeasible,
                "the half-spaces exclude every particle of the belief, and learning ability 1 leaves no doubt"};
  }
  const double sum = detail::exp_below(factors, top, weights_);
  if (effective_size(sum, detail::sum_of_squares(weights_)) < options_.resample_below * static_cast<double>(size())) {
    resample(sum, random);
    return;
  }
  detail::subtract(factors, top, log_weights_);
  log_sum_ = math::log(sum);
  detail::scale_by(1.0 / sum, weights_);
}

// The weights are not divided by their sum, which is `sum`, the largest of them is 1.
void ParticleBelief::resample(double sum, RandomStream& random) {
  const double angle = options_.process_noise > 0.0 && !product_.is_kept() ? kernel_angle(sum) : 0.0;
  detail::Scratch<std::uint32_t, detail::kUsualParticles + detail::kIndexRoom> index{size() + detail::kIndexRoom};
  detail::systematic_indices(weights_, uniform01(random), index.values());
  draw_and_move(index.values().first(size()), angle, random);
  const auto count = static_cast<double>(size());
  std::fill(log_weights_.begin(), log_weights_.end(), 0.0);
  std::fill(weights_.begin(), weights_.end(), 1.0 / count);
  log_sum_ = math::log(count);
  ++num_resamplings_;
}

// h = a * s * M^(-1/(d+3)).
double ParticleBelief::kernel_angle(double sum) const {
  const auto count = static_cast<double>(size());
  const auto centre = mean_direction();
  const double square = detail::SpherePoints{points_, dimension_}.rough_square_angles(weights_, centre) / sum;
  const double exponent = -1.0 / (static_cast<double>(dimension_) + 3.0);
  return options_.process_noise * std::sqrt(square) * math::pow(count, exponent);
}

void ParticleBelief::draw_and_move(std::span<const std::uint32_t> index, double angle, RandomStream& random) {
  detail::draw_points(points_, dimension_, index, angle, prior_normals_, random);
  if (product_.is_kept()) move_in_product(true, random);
}

void ParticleBelief::diffuse(double angle, RandomStream random) {
  if (!(angle >= 0.0 && std::isfinite(angle))) {
    throw std::invalid_argument("ParticleBelief::diffuse: the angle must be finite and not negative");
  }
  if (!(angle > 0.0)) return;
  product_.give_up();
  detail::move_points(points_, dimension_, angle, prior_normals_, random);
}

void ParticleBelief::weigh_by(std::span<const double> factors) {
  const bool is_good = factors.size() == size() && std::all_of(factors.begin(), factors.end(), [](double factor) {
                         return factor >= 0.0 && std::isfinite(factor);
                       });
  double sum = 0.0;
  for (std::size_t i = 0; is_good && i < size(); ++i) sum += weights_[i] * factors[i];
  if (!(sum > 0.0))
    throw std::invalid_argument("ParticleBelief::weigh_by: a factor per point, some weight must remain");
  product_.give_up();
  for (std::size_t i = 0; i < size(); ++i) weights_[i] *= factors[i] / sum;
  take_logs_of_weights();
}

void ParticleBelief::blend(const ParticleBelief& other, double share, RandomStream random) {
  if (!(share >= 0.0 && share <= 1.0) || other.dimension_ != dimension_ || other.size() != size()) {
    throw std::invalid_argument("ParticleBelief::blend: a share in [0, 1], and beliefs of one shape");
  }
  if (share == 0.0) return;
  constexpr double kFewest = 0.05;  // of the points, from either belief
  const auto count = static_cast<double>(size());
  const double wanted = share < 1.0 ? std::clamp(share, kFewest, 1.0 - kFewest) : 1.0;
  const auto others = static_cast<std::size_t>(std::lround(wanted * count));
  std::vector<double> points(points_.size()), weights;
  weights.reserve(size());
  const auto take = [&](const ParticleBelief& from, std::size_t n, double mass, RandomStream stream) {
    for (const auto& [index, times] : from.systematic_draws(n, stream)) {
      for (std::size_t i = 0; i < times; ++i) {
        for (std::size_t k = 0; k < dimension_; ++k) points[k * size() + weights.size()] = from.axis(k)[index];
        weights.push_back(mass / static_cast<double>(n));
      }
    }
  };

  if (others < size()) take(*this, size() - others, 1.0 - share, random.split("own"));
  if (others > 0) take(other, others, share, random.split("other"));
  product_.give_up();
  points_ = std::move(points);
  weights_ = std::move(weights);
  ++num_resamplings_;  // the points are others now
  take_logs_of_weights();
}

// From weights that sum to 1, or nearly so.
void ParticleBelief::take_logs_of_weights() {
  const double top = *std::max_element(weights_.begin(), weights_.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    log_weights_[i] = math::log(weights_[i] / top);
    sum += weights_[i] / top;
  }
  log_sum_ = math::log(sum);
  detail::scale_by(1.0 / (sum * top), weights_);
}

double ParticleBelief::mass_in(std::span<const HalfSpace> half_spaces) const {
  if (half_spaces.empty()) return 1.0;
  return std::min(1.0, detail::SpherePoints{points_, dimension_}.weight_inside(weights_, half_spaces));
}

double ParticleBelief::log_evidence(std::span<const HalfSpace> half_spaces,
                                    const HalfSpaceLikelihood& likelihood) const {
  check(half_spaces, likelihood);
  const double near = static_cast<double>(half_spaces.size()) * likelihood.log_density(0.0);
  detail::ParticleScratch<double> scratch{size()};
  const std::span<double> factors = scratch.values();
  weigh(half_spaces, likelihood, factors);
  const double top = detail::add(log_weights_, factors);
  if (!(top > -std::numeric_limits<double>::infinity())) return top;
  const double sum = detail::exp_below(factors, top, factors);
  return near + (top + math::log(sum) - log_sum_);
}

double ParticleBelief::effective_size(double sum, double sum_of_squares) const noexcept {
  return std::clamp(sum * sum / sum_of_squares, 1.0, static_cast<double>(size()));
}

double ParticleBelief::effective_sample_size() const noexcept {
  return effective_size(1.0, detail::sum_of_squares(weights_));
}

Direction ParticleBelief::mean_direction() const {
  return detail::SpherePoints{points_, dimension_}.mean_direction(weights_);
}

double ParticleBelief::spread() const {
  return std::sqrt(detail::SpherePoints{points_, dimension_}.square_angles(weights_, mean_direction()));
}

std::vector<ParticleBelief::Draw> ParticleBelief::systematic_draws(std::size_t n, RandomStream random) const {
  detail::ParticleScratch<std::uint32_t> scratch{size()};
  const std::span<std::uint32_t> ends = scratch.values();
  detail::systematic_ends(weights_, n, uniform01(random), ends);
  std::vector<Draw> draws;
  draws.reserve(std::min(n, size()));
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i] > begin) draws.push_back({i, ends[i] - begin});
    begin = ends[i];
  }
  return draws;
}

}  // namespace kith
