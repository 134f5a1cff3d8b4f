// Beliefs above three dimensions: what they hold after many observations, beside the product of the likelihoods itself.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/distributions.hpp"
#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

struct Observation {
  HalfSpace half_space;
  double ability = 0.8;
};

HalfSpace axis(std::size_t k, std::int64_t sign, std::size_t d) {
  IntegerVector normal(d);
  normal[k] = sign;
  return HalfSpace{normal};
}

ParticleBelief belief_after(const std::vector<Observation>& observations, std::size_t d) {
  ParticleBelief belief{Cone{d}, {.particles = 1000}};
  RandomStream random{3};
  std::size_t time = 0;
  for (const auto& [half_space, ability] : observations) {
    belief.observe(std::vector{half_space}, HalfSpaceLikelihood{ability, LikelihoodForm::kDiscontinuous, d},
                   random.split(time++));
  }
  return belief;
}

// The share of the product of the likelihoods inside the half-spaces, from points that cover the sphere.
double share_of_product(const std::vector<Observation>& observations, const std::vector<HalfSpace>& inside,
                        std::size_t d) {
  const Eigen::MatrixXd points = ConeSampler{Cone{d}}.cover(100'000);
  double all = 0.0, part = 0.0;
  std::vector<HalfSpaceLikelihood> likelihoods;
  for (const auto& observation : observations)
    likelihoods.emplace_back(observation.ability, LikelihoodForm::kDiscontinuous, d);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Direction point = points.col(i);
    double log_density = 0.0;
    for (std::size_t j = 0; j < observations.size(); ++j) {
      log_density += likelihoods[j].log_relative(observations[j].half_space.unit().dot(point));
    }
    const double density = std::exp(log_density);
    all += density;
    bool is_inside = true;
    for (const auto& half_space : inside) is_inside = is_inside && half_space.contains(point);
    part += is_inside ? density : 0.0;
  }
  return part / all;
}

// As much was observed of either side of every axis but the last, one side first: by symmetry both are equally likely.
TEST(BeliefInMoreDimensions, WeighsWhatItHeardFirstAndLastEqually) {
  for (const std::size_t d : {4u, 6u}) {
    SCOPED_TRACE(d);
    std::vector<Observation> observations;
    std::vector<HalfSpace> late;
    for (const std::int64_t sign : {-1, 1}) {
      for (int i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k + 1 < d; ++k) observations.push_back({axis(k, sign, d), 0.9});
      }
    }
    for (std::size_t k = 0; k + 1 < d; ++k) late.push_back(axis(k, 1, d));
    const auto belief = belief_after(observations, d);
    // Eight standard errors of 1 000 independent points, which these are not.
    for (const auto& half_space : late)
      EXPECT_NEAR(belief.mass_in({&half_space, 1}), 0.5, 8.0 * std::sqrt(0.25 / 1000.0));
    const double all = std::pow(0.5, static_cast<double>(d - 1));
    EXPECT_NEAR(belief.mass_in(late), all, 8.0 * std::sqrt(all / 1000.0));
  }
}

TEST(BeliefInMoreDimensions, HoldsSmallRegions) {
  constexpr std::size_t d = 5;
  std::vector<Observation> observations;
  RandomStream random{8};
  for (int i = 0; i < 12; ++i) {
    IntegerVector normal(d);
    for (std::size_t k = 0; k < d; ++k) normal[k] = static_cast<std::int64_t>(uniform_index(9, random)) - 4;
    normal[d - 1] = 3;
    observations.push_back({HalfSpace{normal}, 0.85});
  }
  const auto belief = belief_after(observations, d);
  for (std::size_t k = 0; k < d; ++k) {
    const std::vector half{axis(k, 1, d)};
    EXPECT_NEAR(belief.mass_in(half), share_of_product(observations, half, d), 8.0 * std::sqrt(0.25 / 1000.0));
  }
}

TEST(BeliefInMoreDimensions, StaysInsideThePrior) {
  constexpr std::size_t d = 4;
  Cone prior{d};
  ASSERT_TRUE(prior.clip(std::vector{axis(3, -1, d)}));
  ParticleBelief belief{prior, {.particles = 500}};
  for (std::size_t i = 0; i < 6; ++i) {
    belief.observe(std::vector{axis(i % 3, 1, d)}, HalfSpaceLikelihood{0.9, LikelihoodForm::kDiscontinuous, d},
                   RandomStream{i});
  }
  EXPECT_GT(belief.num_resamplings(), 0u);
  EXPECT_NEAR(belief.mass_in(std::vector{axis(3, -1, d)}), 1.0, 1e-12);
  for (std::size_t i = 0; i < belief.size(); ++i) EXPECT_NEAR(belief.point(i).norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace kith
