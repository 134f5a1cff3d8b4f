#pragma once

#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"

namespace kith::rivals {

/// The rival of ParticleBelief: the same filter as one would write it first, one particle after the other in double
/// precision, with std::exp for weights, std::log, std::sin and std::cos for the noise, and no care for vectors.
///
/// It draws other random numbers, so weights agree, and points only in distribution.
class NaiveFilter {
 public:
  /// Points and weights of `start`, the prior's half-spaces, and the belief's options.
  NaiveFilter(const ParticleBelief& start, std::span<const HalfSpace> prior, const RandomStream& random);

  /// Weighs by the half-spaces; resamples and moves as ParticleBelief::observe() does.
  void observe(std::span<const HalfSpace> half_spaces, const HalfSpaceLikelihood& likelihood);

  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }
  [[nodiscard]] Eigen::Vector3d mean_direction() const;
  /// Root mean square angle to the mean direction.
  [[nodiscard]] double spread() const;

 private:
  void resample();
  [[nodiscard]] Eigen::Vector3d moved(const Eigen::Vector3d& point, double noise);
  [[nodiscard]] bool is_inside(const Eigen::Vector3d& point) const;

  FilterOptions options_;
  std::vector<HalfSpace> prior_;
  RandomStream random_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> log_weights_;
  std::vector<double> weights_;
};

}  // namespace kith::rivals
