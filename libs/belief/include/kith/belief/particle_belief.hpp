#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/likelihood_product.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/core/stream.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/geometry/eigen.hpp"

namespace kith {

/// How a particle belief is updated.
struct FilterOptions {
  std::size_t particles = 1000;  ///< M >= 1.
  double process_noise = 0.1;    ///< eta: bandwidth factor a >= 0 of the kernel after resampling.
  double resample_below = 0.5;   ///< Resample when effective sample size / M is below this; in [0, 1].
  bool records_support = false;  ///< Whether least_support() is kept, at one pass over the points per update.
  friend bool operator==(const FilterOptions&, const FilterOptions&) = default;
};

/// A belief with a smaller ParticleBelief::least_support() is impoverished.
inline constexpr double kFewParticles = 10.0;

/// A belief about the reward weights: M weighted points of the unit sphere in
/// d = 2 to 8 dimensions, none of them outside the hard prior.
///
/// An update multiplies the weights by the likelihoods of all half-spaces at
/// once, in log space, and normalises. The log weights are kept, so no product
/// underflows, however long. When the effective sample size
/// 1 / sum p_i^2 falls below its threshold, the points are resampled
/// systematically and each is moved by N(0, h^2) per axis in its tangent plane,
///   h = a * s * M^(-1/(d+3)),
/// where s is the root mean square geodesic distance of the weighted points to
/// their normalised mean, taken before resampling. A move that would leave the
/// prior is drawn again, at most 20 times, else the point stays.
///
/// Above three dimensions such moves would lose regions that M points cannot keep. As long as the belief is a product
/// of likelihoods (nothing but observe() happened) and process_noise > 0, it is updated as a sequential Monte Carlo
/// sampler [delmoral2006]. An observation that would leave too few effective particles is taken in by stages
/// (tempering): each raises the share of it that counts by as much as leaves an effective sample size of resample_below
/// M / 2, then the points are resampled and move. Points move by slice sampling along random great circles
/// [habeck2023], which leaves the product as it is: after each resampling in rounds of two moves until the correlation
/// of the points with where they began is below 0.3 (at most 40 moves), and once after four observations without a
/// move.
class ParticleBelief {
 public:
  /// Uniform over the prior: exactly M points of a regular cover, weights 1/M.
  /// `prior` may be the whole sphere. @throws std::invalid_argument on bad options.
  ParticleBelief(const Cone& prior, const FilterOptions& options);
  /// The same, from a cover made before. @throws std::invalid_argument also unless it has options.particles points.
  ParticleBelief(const PriorCover& cover, const FilterOptions& options);

  [[nodiscard]] std::size_t size() const noexcept { return weights_.size(); }
  /// d.
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }
  /// Coordinate k of all points, shape [size()]. @pre k < dimension().
  [[nodiscard]] std::span<const double> axis(std::size_t k) const noexcept {
    return {points_.data() + k * size(), size()};
  }
  [[nodiscard]] std::span<const double> x() const noexcept { return axis(0); }
  [[nodiscard]] std::span<const double> y() const noexcept { return axis(1); }
  /// @pre dimension() > 2.
  [[nodiscard]] std::span<const double> z() const noexcept { return axis(2); }
  /// Sum to 1. Shape [size()].
  [[nodiscard]] std::span<const double> weights() const noexcept { return weights_; }
  /// Shape [d], of length 1.
  [[nodiscard]] Direction point(std::size_t i) const {
    Direction point(static_cast<Eigen::Index>(dimension_));
    for (std::size_t k = 0; k < dimension_; ++k) point[static_cast<Eigen::Index>(k)] = points_[k * size() + i];
    return point;
  }
  [[nodiscard]] const FilterOptions& options() const noexcept { return options_; }

  /// Bayes update with the product of the half-spaces' likelihoods; an empty list changes nothing.
  /// A half-space listed twice counts twice; the order does not change a bit. Without a resampling, `random`
  /// is not used; with one, its first draw is the systematic offset and the rest moves the points.
  /// @throws kith::Error (kInfeasible), and leaves the belief as it was, if no particle remains possible;
  /// std::invalid_argument unless belief, half-spaces and likelihood have the same dimension.
  void observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood, RandomStream random);

  /// Update of a joint belief: each point's factor is the largest, over the
  /// alternatives, of the product of relative likelihoods (near side = 1), so a
  /// point that fits any one of them keeps its weight. An empty alternative fits
  /// everywhere; no alternatives change nothing.
  void observe_any(std::span<const std::vector<HalfSpace>> alternatives, const HalfSpaceLikelihood& likelihood,
                   RandomStream random);

  /// Moves every point by N(0, angle^2) per axis in its tangent plane (radians),
  /// inside the prior; weights stay. The teacher's doubt after a test.
  void diffuse(double angle, RandomStream random);

  /// Multiplies the weights by these factors, without a resampling. Shape [size()].
  /// @throws std::invalid_argument unless there is a factor >= 0 for every point, and some weight remains.
  void weigh_by(std::span<const double> factors);

  /// Becomes (1 - share) times this belief plus share times another one, as many points as before: at least a twentieth
  /// of them from either, drawn systematically; all from one if share is 0 or 1.
  /// @throws std::invalid_argument unless 0 <= share <= 1 and both have the same dimension and as many points.
  void blend(const ParticleBelief& other, double share, RandomStream random);

  /// Sum of the weights of the points that satisfy all half-spaces; 1 for an empty list.
  [[nodiscard]] double mass_in(std::span<const HalfSpace> half_spaces) const;

  /// log of the expected product of the likelihoods, log sum_i p_i prod_j p(x_i | c_j).
  [[nodiscard]] double log_evidence(std::span<const HalfSpace> half_spaces,
                                    const HalfSpaceLikelihood& likelihood) const;

  /// 1 / sum p_i^2, in [1, size()].
  [[nodiscard]] double effective_sample_size() const noexcept;
  /// The normalised weighted mean direction; the first point's direction if the mean vanishes.
  [[nodiscard]] Direction mean_direction() const;
  /// Root mean square geodesic distance to mean_direction(), radians.
  [[nodiscard]] double spread() const;

  /// n systematic draws by weight (one offset for all): per drawn point its
  /// index and how often it was drawn, in index order.
  struct Draw {
    std::size_t index;
    std::size_t count;
  };
  [[nodiscard]] std::vector<Draw> systematic_draws(std::size_t n, RandomStream random) const;

  /// How well the points could represent what was shown: the smallest effective number of points, over all updates,
  /// that satisfied all half-spaces, or those of an alternative, when they were taken in,
  /// (sum p_i)^2 / sum p_i^2 over these points. size() before any update; 0 if no point satisfied them.
  /// Where it is below kFewParticles the belief is impoverished: what it holds from then on depends on which few points
  /// happened to fit. Updates of a product of likelihoods above three dimensions do not count, since there stages and
  /// slice moves renew the points, nor do updates that all points satisfy. size() unless
  /// FilterOptions::records_support.
  [[nodiscard]] double least_support() const noexcept { return least_support_; }

  /// How often this belief was resampled so far.
  [[nodiscard]] std::size_t num_resamplings() const noexcept { return num_resamplings_; }

  /// The same points, weights and options, bit for bit.
  friend bool operator==(const ParticleBelief&, const ParticleBelief&) = default;

 private:
  void check(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood) const;
  void weigh(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
             std::span<double> factors) const;
  [[nodiscard]] double support(std::span<const double> log_factors) const noexcept;
  void reweigh_and_record(std::span<double> log_factors, RandomStream random);
  void reweigh(std::span<double> log_factors, RandomStream random);
  [[nodiscard]] double effective_size(double sum, double sum_of_squares) const noexcept;
  void resample(double sum, RandomStream& random);
  [[nodiscard]] double kernel_angle(double sum) const;
  void draw_and_move(std::span<const std::uint32_t> index, double angle, RandomStream& random);
  void observe_in_product(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood,
                          std::span<double> factors, const RandomStream& random);
  [[nodiscard]] double affordable_share(std::span<const double> factors, double most) const;
  void take_logs_of_weights();
  void move_in_product(bool is_resampled, RandomStream& random);

  FilterOptions options_;
  std::size_t dimension_;
  std::vector<Direction> prior_normals_;
  std::vector<double> points_;       // shape [d, M]
  std::vector<double> log_weights_;  // up to a constant; the largest is 0
  std::vector<double> weights_;      // exp(log_weights_) / their sum
  double log_sum_ = 0.0;             // log of that sum
  std::size_t num_resamplings_ = 0;
  double least_support_;               // see least_support()
  detail::LikelihoodProduct product_;  // kept above three dimensions
  std::size_t num_still_ = 0;          // observations since the points moved in it
};

/// Systematic resampling (Kitagawa 1996): counts of each index among n strata of
/// the cumulative weights with one offset u in [0, 1). |count_i - n p_i| < 1 for every i.
[[nodiscard]] std::vector<std::size_t> systematic_counts(std::span<const double> weights, std::size_t n, double u);

}  // namespace kith
