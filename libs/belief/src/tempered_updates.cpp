// Updates of a belief above three dimensions, as long as it is a product of likelihoods: a sequential Monte Carlo
// sampler [delmoral2006], whose points move by slice sampling and not by a kernel.
#include <cmath>
#include <vector>

#include "kernels.hpp"
#include "kith/belief/particle_belief.hpp"
#include "scratch.hpp"
#include "slice_moves.hpp"

namespace kith {
namespace {

constexpr double kLeastOfStage = 0.5;    // effective sample size that a stage leaves, over that of resampling
constexpr std::size_t kMostStages = 50;  // of one observation
// After a resampling, points move until little is left of where they were.
constexpr std::size_t kSweeps = 2;       // between two looks
constexpr std::size_t kMostSweeps = 40;  // altogether
constexpr double kForgotten = 0.3;       // correlation of where points were and are
constexpr std::size_t kMostStill = 4;    // observations without a move

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

}  // namespace

// Tempering: the observation is taken in by stages, each of which raises the share that counts by as much as leaves
// enough effective particles; they are resampled and moved before the next [delmoral2006].
void ParticleBelief::observe_in_product(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                                        std::span<double> factors, const RandomStream& random) {
  const auto before = product_;
  double done = 0.0;
  for (std::size_t stage = 0; done < 1.0; ++stage) {
    if (stage > 0) weigh(half_spaces, likelihood, factors);
    const double rest = 1.0 - done;
    const double share = likelihood.is_hard() || stage + 1 == kMostStages ? rest : affordable_share(factors, rest);
    done = share < rest ? done + share : 1.0;
    if (share < 1.0) {
      for (double& factor : factors) factor *= share;
    }
    product_.add(half_spaces, likelihood, share);
    try {
      reweigh(factors, stage == 0 ? random : random.split(stage));
    } catch (...) {
      product_ = before;
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

// One sweep, or as many after a resampling as it takes to forget where points were.
void ParticleBelief::move_in_product(bool is_resampled, RandomStream& random) {
  const detail::FallingDensity density = product_.density(prior_normals_);
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

}  // namespace kith
