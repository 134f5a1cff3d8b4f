#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/distributions.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::testing {

/// Half-spaces that are observed together.
struct SimulatedObservation {
  std::vector<HalfSpace> half_spaces;
  HalfSpaceLikelihood likelihood;
};

/// What is known beforehand: the last weight is negative.
inline Cone negative_last(std::size_t d) {
  IntegerVector normal(d);
  normal[d - 1] = -1;
  return Cone{d}.clipped(HalfSpace{normal}).value();
}

/// A uniform direction of negative_last(d).
inline Direction draw_truth(std::size_t d, RandomStream& random) {
  Direction truth(static_cast<Eigen::Index>(d));
  fill_standard_normal({truth.data(), d}, random);
  truth[truth.size() - 1] = -std::abs(truth[truth.size() - 1]);
  return truth.normalized();
}

/// A half-space whose unit normal u has a density in proportion to p(truth | u). Since the integral of p(w | u) over
/// all u is the same for every w, the posterior is the prior times the product of the likelihoods. By rejection of
/// uniform normals, which are rounded to multiples of 1/1000.
inline HalfSpace draw_half_space(const Direction& truth, const HalfSpaceLikelihood& likelihood, RandomStream& random) {
  const std::size_t d = likelihood.dimension();
  for (;;) {
    Direction normal(static_cast<Eigen::Index>(d));
    fill_standard_normal({normal.data(), d}, random);
    normal.normalize();
    if (!(std::log(uniform01(random)) < likelihood.log_relative(normal.dot(truth)))) continue;
    IntegerVector rounded(d);
    for (std::size_t k = 0; k < d; ++k) rounded[k] = std::llround(1000.0 * normal[static_cast<Eigen::Index>(k)]);
    return HalfSpace{rounded};
  }
}

/// The likelihoods of people of different ability; quadrature makes each of them slow to compute.
inline std::vector<HalfSpaceLikelihood> some_likelihoods(std::size_t d) {
  std::vector<HalfSpaceLikelihood> list;
  for (const double ability : {0.65, 0.8, 0.9}) list.emplace_back(ability, LikelihoodForm::kDiscontinuous, d);
  return list;
}

/// `updates` observations of one or two half-spaces each.
inline std::vector<SimulatedObservation> draw_observations(const Direction& truth, std::size_t updates,
                                                           std::span<const HalfSpaceLikelihood> likelihoods,
                                                           RandomStream& random) {
  std::vector<SimulatedObservation> list;
  for (std::size_t t = 0; t < updates; ++t) {
    SimulatedObservation one{{}, likelihoods[uniform_index(likelihoods.size(), random)]};
    const std::size_t n = 1 + uniform_index(2, random);
    for (std::size_t i = 0; i < n; ++i) one.half_spaces.push_back(draw_half_space(truth, one.likelihood, random));
    list.push_back(one);
  }
  return list;
}

inline void observe_all(ParticleBelief& belief, std::span<const SimulatedObservation> observations,
                        const RandomStream& random) {
  std::uint64_t time = 0;
  for (const auto& observation : observations)
    belief.observe(observation.half_spaces, observation.likelihood, random.split(time++));
}

/// log of the product of the relative likelihoods at w.
inline double log_product(std::span<const SimulatedObservation> observations, const Direction& w) {
  double sum = 0.0;
  for (const auto& observation : observations) {
    for (const HalfSpace& h : observation.half_spaces) sum += observation.likelihood.log_relative(h.margin(w));
  }
  return sum;
}

/// An estimate and its standard error.
struct Estimate {
  double mean = 0.0;
  double standard_error = 0.0;
};

inline Estimate estimate_from(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += (value - sum / n) * (value - sum / n);
  return {sum / n, std::sqrt(squares / (n - 1.0) / n)};
}

/// The posterior mass of each region by a Metropolis chain on the part of the sphere where the last weight is negative:
/// steps of three sizes, uniform in direction. The chain starts at the truth, which is a draw from the posterior.
/// Standard errors from 50 batches.
inline std::vector<Estimate> chain_masses(const Direction& truth, std::span<const SimulatedObservation> observations,
                                          std::span<const std::vector<HalfSpace>> regions, std::size_t steps,
                                          RandomStream random) {
  constexpr std::size_t kBatches = 50;
  const auto d = truth.size();
  Eigen::MatrixXd normals(0, d);
  Eigen::VectorXd far, slope;
  for (const auto& observation : observations) {
    for (const HalfSpace& h : observation.half_spaces) {
      const auto n = normals.rows();
      normals.conservativeResize(n + 1, d);
      far.conservativeResize(n + 1);
      slope.conservativeResize(n + 1);
      normals.row(n) = h.unit().transpose();
      far[n] = observation.likelihood.log_far();
      slope[n] = observation.likelihood.concentration();
    }
  }
  const auto log_density = [&](const Eigen::VectorXd& w) {
    const Eigen::ArrayXd t = (normals * w).array();
    return (t < 0.0).select(far.array() + slope.array() * t, 0.0).sum();
  };
  Eigen::VectorXd at = truth;
  double density = log_density(at);
  std::vector<std::vector<double>> batches(regions.size());
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    std::vector<double> inside(regions.size(), 0.0);
    for (std::size_t step = 0; step < steps / kBatches; ++step) {
      constexpr double kSizes[] = {0.1, 0.3, 1.0};
      Eigen::VectorXd to(d);
      fill_standard_normal({to.data(), static_cast<std::size_t>(d)}, random);
      to = (at + kSizes[uniform_index(3, random)] / std::sqrt(static_cast<double>(d)) * to).normalized();
      if (to[d - 1] <= 0.0) {
        const double next = log_density(to);
        if (std::log(uniform01(random)) < next - density) {
          at = to;
          density = next;
        }
      }
      for (std::size_t r = 0; r < regions.size(); ++r) {
        inside[r] += std::all_of(regions[r].begin(), regions[r].end(), [&](const auto& h) { return h.contains(at); });
      }
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      batches[r].push_back(inside[r] / static_cast<double>(steps / kBatches));
    }
  }
  std::vector<Estimate> result;
  for (const auto& values : batches) result.push_back(estimate_from(values));
  return result;
}

}  // namespace kith::testing
