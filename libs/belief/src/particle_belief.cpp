#include "kith/belief/particle_belief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "general_kernels.hpp"
#include "kernels.hpp"
#include "kith/core/error.hpp"
#include "kith/random/distributions.hpp"
#include "scratch.hpp"
#include "slice_moves.hpp"
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

constexpr std::size_t kSpace = 3;  // the dimension with kernels of its own
// Above three dimensions:
constexpr double kLeastOfStage = 0.5;    // effective sample size that a stage leaves, over that of resampling
constexpr std::size_t kMostStages = 50;  // of one observation
// After a resampling, points move until little is left of where they were.
constexpr std::size_t kSweeps = 2;       // between two looks
constexpr std::size_t kMostSweeps = 40;  // altogether
constexpr double kForgotten = 0.3;       // correlation of where points were and are
constexpr std::size_t kMostStill = 4;    // observations without a move

// The axes of points in space.
detail::MutablePoints in_space(std::vector<double>& points) {
  const std::span<double> all{points};
  const std::size_t n = points.size() / kSpace;
  return {all.first(n), all.subspan(n, n), all.last(n)};
}

// Normals in space, for the time of one call.
class NormalsInSpace {
 public:
  explicit NormalsInSpace(const std::vector<Direction>& normals) : normals_{normals.size()} {
    std::transform(normals.begin(), normals.end(), normals_.values().begin(),
                   [](const Direction& normal) { return Eigen::Vector3d{normal}; });
  }
  [[nodiscard]] std::span<const Eigen::Vector3d> list() { return normals_.values(); }

 private:
  detail::Scratch<Eigen::Vector3d, 16> normals_;
};

// Correlation of two lists of n unit vectors, axis by axis: (mean a_i . b_i - mean a . mean b) over the mean of both
// variances, which are 1 - |mean|^2. 0 if nothing varies.
double correlation(std::span<const double> a, std::span<const double> b, std::size_t d) {
  const std::size_t count = a.size() / d;
  const auto n = static_cast<double>(count);
  double product = 0.0, of_means = 0.0, square = 0.0;
  for (std::size_t k = 0; k < d; ++k) {
    double sum_a = 0.0, sum_b = 0.0;
    for (std::size_t i = k * count; i < (k + 1) * count; ++i) {
      sum_a += a[i];
      sum_b += b[i];
      product += a[i] * b[i];
    }
    of_means += sum_a * sum_b / (n * n);
    square += 0.5 * (sum_a * sum_a + sum_b * sum_b) / (n * n);
  }
  return square < 1.0 ? (product / n - of_means) / (1.0 - square) : 0.0;
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
      log_sum_{std::log(static_cast<double>(cover.size()))},
      least_support_{static_cast<double>(cover.size())} {
  if (cover.size() != options.particles) {
    throw std::invalid_argument("ParticleBelief: the cover must have as many points as the belief has particles");
  }
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
  if (dimension_ == kSpace) {
    detail::log_relative_products({x(), y(), z()}, detail::Planes{half_spaces, likelihood}.list(), factors);
  } else {
    detail::log_relative_products(detail::AxisPoints{points_, dimension_}, half_spaces, likelihood, factors);
  }
}

void ParticleBelief::observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                             RandomStream random) {
  check(half_spaces, likelihood);
  if (half_spaces.empty() || is_constant(likelihood)) return;
  detail::ParticleScratch<double> factors{size()};
  weigh(half_spaces, likelihood, factors.values());
  if (!keeps_product()) return reweigh_and_record(factors.values(), random);
  observe_in_product(half_spaces, likelihood, factors.values(), random);
}

// Tempering: the observation is taken in by stages, each of which raises the share that counts by as much as leaves
// enough effective particles; they are resampled and moved before the next [delmoral2006].
void ParticleBelief::observe_in_product(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                                        std::span<double> factors, const RandomStream& random) {
  const auto before = observed_;
  double done = 0.0;
  for (std::size_t stage = 0; done < 1.0; ++stage) {
    if (stage > 0) weigh(half_spaces, likelihood, factors);
    const double rest = 1.0 - done;
    const double share = likelihood.is_hard() || stage + 1 == kMostStages ? rest : affordable_share(factors, rest);
    done = share < rest ? done + share : 1.0;
    if (share < 1.0) {
      for (double& factor : factors) factor *= share;
    }
    remember(half_spaces, likelihood, share);
    try {
      reweigh(factors, stage == 0 ? random : random.split(stage));
    } catch (...) {
      observed_ = before;
      throw;
    }
  }
  if (++num_still_ < kMostStill) return;
  auto more = random.split("moves");
  move_in_product(false, more);
}

// The largest share of the log factors, at most `most`, that leaves enough effective particles; by bisection.
double ParticleBelief::affordable_share(std::span<const double> factors, double most) const {
  const double least = kLeastOfStage * options_.resample_below * static_cast<double>(size());
  detail::ParticleScratch<double> scratch{size()};
  const std::span<double> values = scratch.values();
  const auto leaves_enough = [&](double share) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = share * factors[i];
    const double top = detail::add(log_weights_, values);
    const double sum = detail::exp_below(values, top, values);
    return effective_size(sum, detail::sum_of_squares(values)) >= least;
  };
  if (leaves_enough(most)) return most;
  double low = 0.0, high = most;
  constexpr int kHalvings = 12;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (leaves_enough(middle) ? low : high) = middle;
  }
  return low > 0.0 ? low : high;
}

bool ParticleBelief::keeps_product() const noexcept {
  return dimension_ > kSpace && is_product_ && options_.process_noise > 0.0;
}

// What happened is no product of likelihoods any more; that of space is never asked for.
void ParticleBelief::lose_product() {
  if (dimension_ <= kSpace) return;
  is_product_ = false;
  observed_.clear();
}

void ParticleBelief::remember(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                              double share) {
  std::vector<HalfSpace> sorted{half_spaces.begin(), half_spaces.end()};
  std::sort(sorted.begin(), sorted.end());
  for (const HalfSpace& half_space : sorted) {
    auto place = std::lower_bound(observed_.begin(), observed_.end(), half_space,
                                  [](const Observed& one, const HalfSpace& h) { return one.half_space < h; });
    if (place == observed_.end() || !(place->half_space == half_space)) {
      place = observed_.insert(place, {half_space, 0.0, 0.0});
    }
    place->far += share * likelihood.log_far();
    place->slope += share * likelihood.concentration();
  }
}

// One sweep, or as many after a resampling as it takes to forget where points were.
void ParticleBelief::move_in_product(bool is_resampled, RandomStream& random) {
  detail::FallingDensity density;
  density.dimension = dimension_;
  for (const Direction& normal : prior_normals_)
    density.prior.insert(density.prior.end(), normal.begin(), normal.end());
  for (const Observed& one : observed_) {
    const Direction normal = one.half_space.unit();
    density.normals.insert(density.normals.end(), normal.begin(), normal.end());
    density.far.push_back(one.far);
    density.slope.push_back(one.slope);
  }
  num_still_ = 0;
  if (!is_resampled) {
    detail::move_in_density(density, 1, points_, random);
    return;
  }
  const std::vector<double> start = points_;
  for (std::size_t done = 0; done < kMostSweeps; done += kSweeps) {
    detail::move_in_density(density, kSweeps, points_, random);
    if (correlation(start, points_, dimension_) < kForgotten) return;
  }
}

void ParticleBelief::observe_any(std::span<const std::vector<HalfSpace>> alternatives,
                                 const HalfSpaceLikelihood& likelihood, RandomStream random) {
  for (const auto& alternative : alternatives) check(alternative, likelihood);
  const bool fits_everywhere =
      std::any_of(alternatives.begin(), alternatives.end(), [](const auto& list) { return list.empty(); });
  if (alternatives.empty() || fits_everywhere || is_constant(likelihood)) return;
  lose_product();
  detail::ParticleScratch<double> best{size()};
  detail::ParticleScratch<double> factors{size()};
  weigh(alternatives[0], likelihood, best.values());
  for (const auto& alternative : alternatives.subspan(1)) {
    weigh(alternative, likelihood, factors.values());
    detail::raise(factors.values(), best.values());
  }
  reweigh_and_record(best.values(), random);
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
  log_sum_ = std::log(sum);
  detail::scale_by(1.0 / sum, weights_);
}

// The weights are not divided by their sum, which is `sum`, the largest of them is 1.
void ParticleBelief::resample(double sum, RandomStream& random) {
  const double angle = options_.process_noise > 0.0 && !keeps_product() ? kernel_angle(sum) : 0.0;
  detail::Scratch<std::uint32_t, detail::kUsualParticles + detail::kIndexRoom> index{size() + detail::kIndexRoom};
  detail::systematic_indices(weights_, uniform01(random), index.values());
  draw_and_move(index.values().first(size()), angle, random);
  const auto count = static_cast<double>(size());
  std::fill(log_weights_.begin(), log_weights_.end(), 0.0);
  std::fill(weights_.begin(), weights_.end(), 1.0 / count);
  log_sum_ = std::log(count);
  ++num_resamplings_;
}

// h = a * s * M^(-1/(d+3)).
double ParticleBelief::kernel_angle(double sum) const {
  const auto count = static_cast<double>(size());
  const auto centre = mean_direction();
  const double square =
      dimension_ == kSpace
          ? detail::rough_square_angles({x(), y(), z()}, weights_, Eigen::Vector3d{centre}) / sum
          : detail::weighted_square_angles(detail::AxisPoints{points_, dimension_}, weights_, centre) / sum;
  const double exponent = dimension_ == kSpace ? -1.0 / 6.0 : -1.0 / (static_cast<double>(dimension_) + 3.0);
  return options_.process_noise * std::sqrt(square) * std::pow(count, exponent);
}

void ParticleBelief::draw_and_move(std::span<const std::uint32_t> index, double angle, RandomStream& random) {
  if (dimension_ != kSpace) {
    std::vector<double> drawn(points_.size());
    detail::gather(detail::AxisPoints{points_, dimension_}, index, drawn);
    points_ = std::move(drawn);
    if (keeps_product()) {
      move_in_product(true, random);
    } else if (angle > 0.0) {
      move(angle, random);
    }
    return;
  }
  detail::ParticleScratch<double> x{size()};
  detail::ParticleScratch<double> y{size()};
  detail::ParticleScratch<double> z{size()};
  const detail::MutablePoints drawn{x.values(), y.values(), z.values()};
  detail::gather({this->x(), this->y(), this->z()}, index, drawn);
  const detail::MutablePoints to = in_space(points_);
  if (angle > 0.0) {
    detail::move_points({drawn.x, drawn.y, drawn.z}, angle, NormalsInSpace{prior_normals_}.list(), random, to);
  } else {
    std::copy(drawn.x.begin(), drawn.x.end(), to.x.begin());
    std::copy(drawn.y.begin(), drawn.y.end(), to.y.begin());
    std::copy(drawn.z.begin(), drawn.z.end(), to.z.begin());
  }
}

void ParticleBelief::diffuse(double angle, RandomStream random) {
  if (!(angle >= 0.0 && std::isfinite(angle))) {
    throw std::invalid_argument("ParticleBelief::diffuse: the angle must be finite and not negative");
  }
  if (!(angle > 0.0)) return;
  lose_product();
  move(angle, random);
}

void ParticleBelief::move(double angle, RandomStream& random) {
  if (dimension_ == kSpace) {
    detail::move_points({x(), y(), z()}, angle, NormalsInSpace{prior_normals_}.list(), random, in_space(points_));
  } else {
    detail::move_points(points_, dimension_, angle, prior_normals_, random);
  }
}

void ParticleBelief::weigh_by(std::span<const double> factors) {
  const bool is_good = factors.size() == size() && std::all_of(factors.begin(), factors.end(), [](double factor) {
                         return factor >= 0.0 && std::isfinite(factor);
                       });
  double sum = 0.0;
  for (std::size_t i = 0; is_good && i < size(); ++i) sum += weights_[i] * factors[i];
  if (!(sum > 0.0))
    throw std::invalid_argument("ParticleBelief::weigh_by: a factor per point, some weight must remain");
  lose_product();
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
  lose_product();
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
    log_weights_[i] = std::log(weights_[i] / top);
    sum += weights_[i] / top;
  }
  log_sum_ = std::log(sum);
  detail::scale_by(1.0 / (sum * top), weights_);
}

double ParticleBelief::mass_in(std::span<const HalfSpace> half_spaces) const {
  if (half_spaces.empty()) return 1.0;
  const double inside = dimension_ == kSpace
                            ? detail::weight_inside({x(), y(), z()}, weights_, half_spaces)
                            : detail::weight_inside(detail::AxisPoints{points_, dimension_}, weights_, half_spaces);
  return std::min(1.0, inside);
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
  return near + (top + std::log(sum) - log_sum_);
}

double ParticleBelief::effective_size(double sum, double sum_of_squares) const noexcept {
  return std::clamp(sum * sum / sum_of_squares, 1.0, static_cast<double>(size()));
}

double ParticleBelief::effective_sample_size() const noexcept {
  return effective_size(1.0, detail::sum_of_squares(weights_));
}

Direction ParticleBelief::mean_direction() const {
  if (dimension_ != kSpace) {
    const Direction mean = detail::weighted_sum(detail::AxisPoints{points_, dimension_}, weights_);
    const double length = mean.norm();
    if (length < 1e-12) return point(0);
    return mean / length;
  }
  const Eigen::Vector3d mean = detail::weighted_sum({x(), y(), z()}, weights_);
  const double length = mean.norm();
  if (length < 1e-12) return point(0);
  return Direction{mean / length};
}

double ParticleBelief::spread() const {
  const Direction centre = mean_direction();
  if (dimension_ != kSpace) {
    return std::sqrt(detail::weighted_square_angles(detail::AxisPoints{points_, dimension_}, weights_, centre));
  }
  return std::sqrt(detail::weighted_square_angles({x(), y(), z()}, weights_, Eigen::Vector3d{centre}));
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
