// When a ParticleBelief resamples, and how its points move.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "kith/belief/particle_belief.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::kWeighOnly;
using kith::testing::lower_hemisphere;
using kith::testing::random_half_space;
using kith::testing::random_list;
using kith::testing::total;

TEST(ParticleMotion, ResamplesExactlyBelowTheThreshold) {
  RandomStream random{16};
  for (const double threshold : {0.0, 0.3, 0.5, 0.8}) {
    ParticleBelief belief{lower_hemisphere(), {.process_noise = 0.1, .resample_below = threshold}};
    for (int update = 0; update < 30; ++update) {
      const auto list = random_list(2, random);
      const std::size_t before = belief.num_resamplings();
      std::vector<double> weights(belief.weights().begin(), belief.weights().end());
      for (std::size_t i = 0; i < weights.size(); ++i) {
        for (const HalfSpace& h : list) weights[i] *= HalfSpaceLikelihood{0.9}.density(h.margin(belief.point(i)));
      }
      double squares = 0.0;
      for (const double w : weights) squares += w * w;
      const double effective = total(weights) * total(weights) / squares;
      belief.observe(list, HalfSpaceLikelihood{0.9}, random.split(static_cast<std::uint64_t>(update)));
      const bool resampled = belief.num_resamplings() > before;
      EXPECT_EQ(resampled, effective < threshold * 1000.0);
      EXPECT_GE(belief.effective_sample_size(), std::max(1.0, threshold * 1000.0) * (1.0 - 1e-12));
      EXPECT_LE(belief.effective_sample_size(), 1000.0);
    }
  }
}

TEST(ParticleMotion, NeverCrossesThePrior) {
  RandomStream random{17};
  std::size_t num_resamplings = 0;
  for (int round = 0; round < 12; ++round) {
    std::optional<Cone> prior = lower_hemisphere();
    for (int clip = 0; clip < round % 4; ++clip) {
      if (const auto smaller = prior->clipped(random_half_space(random))) prior = smaller;
    }
    ParticleBelief belief{*prior, {.particles = 300, .process_noise = round % 2 == 0 ? 0.3 : 3.0}};
    for (std::uint64_t update = 0; update < 40; ++update) {
      belief.observe(random_list(2, random), HalfSpaceLikelihood{0.9}, random.split(update));
      belief.diffuse(update % 5 == 0 ? 1.0 : 0.05, random.split(1000 + update));
    }
    for (std::size_t i = 0; i < belief.size(); ++i) {
      ASSERT_TRUE(prior->contains(belief.point(i)));
      ASSERT_NEAR(belief.point(i).norm(), 1.0, 1e-14);
    }
    num_resamplings += belief.num_resamplings();
  }
  EXPECT_GT(num_resamplings, 100u);
}

TEST(ParticleMotion, KeepsTheWeightsWhileItDiffuses) {
  RandomStream random{18};
  ParticleBelief belief{lower_hemisphere(), kWeighOnly};
  belief.observe(random_list(3, random), HalfSpaceLikelihood{0.9}, random);
  const ParticleBelief before = belief;
  belief.diffuse(0.0, RandomStream{1});
  EXPECT_EQ(belief, before);
  belief.diffuse(0.05, RandomStream{1});
  EXPECT_TRUE(std::equal(before.weights().begin(), before.weights().end(), belief.weights().begin()));
  EXPECT_NE(belief, before);
}

// The bandwidth is a s M^(-1/6). All weight on one spot of a tiny spread gives a
// tiny kernel, a flat belief a wide one: the displacement of the survivors shows
// it. E r^2 = 2 h^2; with 4 000 points 5 standard errors are 8 %.
TEST(ParticleMotion, MovesByTheStatedBandwidth) {
  constexpr std::size_t n = 4000;
  const HalfSpaceLikelihood likelihood{0.95};
  const std::vector list{HalfSpace{{1, 0, 0}}, HalfSpace{{0, 1, 0}}, HalfSpace{{2, 1, 1}}};
  for (const double a : {0.1, 0.4}) {
    const FilterOptions moving{.particles = n, .process_noise = a, .resample_below = 1.0};
    FilterOptions still = moving;
    still.process_noise = 0.0;
    FilterOptions weighing = still;
    weighing.resample_below = 0.0;
    const PriorCover cover{Cone{}, n};
    ParticleBelief moved{cover, moving};
    ParticleBelief kept{cover, still};
    ParticleBelief weighed{cover, weighing};
    for (auto* belief : {&moved, &kept, &weighed}) belief->observe(list, likelihood, RandomStream{19});
    const double bandwidth = a * weighed.spread() * std::pow(static_cast<double>(n), -1.0 / 6.0);
    double second = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double r = 2.0 * std::asin(std::min(1.0, 0.5 * (moved.point(i) - kept.point(i)).norm()));
      second += r * r / static_cast<double>(n);
    }
    EXPECT_NEAR(second / (2.0 * bandwidth * bandwidth), 1.0, 0.08);
  }
}

TEST(ParticleMotion, DependsOnItsArgumentsAndTheStreamOnly) {
  RandomStream random{20};
  const auto list = random_list(4, random);
  ParticleBelief a{lower_hemisphere(), {}};
  ParticleBelief b = a;
  ParticleBelief c = a;
  for (std::uint64_t update = 0; update < 5; ++update) {
    a.observe(list, HalfSpaceLikelihood{0.95}, RandomStream{update});
    b.observe(list, HalfSpaceLikelihood{0.95}, RandomStream{update});
    c.observe(list, HalfSpaceLikelihood{0.95}, RandomStream{update + 100});
  }
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
}

TEST(ParticleMotion, WeighsByFactors) {
  const HalfSpace side{IntegerVector{1, 2, 0}};
  ParticleBelief belief{lower_hemisphere(), {}};
  std::vector<double> factors;
  for (std::size_t i = 0; i < belief.size(); ++i) factors.push_back(side.contains(belief.point(i)) ? 1.0 : 3.0);
  const double before = belief.mass_in(std::array{side});
  belief.weigh_by(factors);
  EXPECT_NEAR(belief.mass_in(std::array{side}), before / (before + 3.0 * (1.0 - before)), 1e-12);
  EXPECT_NEAR(total(belief.weights()), 1.0, 1e-12);
  EXPECT_THROW(belief.weigh_by(std::vector<double>(belief.size(), 0.0)), std::invalid_argument);
  EXPECT_THROW(belief.weigh_by(std::vector<double>(3, 1.0)), std::invalid_argument);
}

// Every mass is the mixture of both beliefs' masses, up to what systematic draws leave: a few of the points that come
// from either. Later updates go on from there.
TEST(ParticleMotion, BlendsTwoBeliefs) {
  const HalfSpace side{IntegerVector{1, 2, 0}};
  const auto list = std::array{side};
  ParticleBelief one{lower_hemisphere(), {}};
  const auto start = one;
  RandomStream random{20};
  for (std::uint64_t i = 0; i < 4; ++i) one.observe(list, HalfSpaceLikelihood{0.8}, random.split(i));
  for (const double share : {0.0, 0.01, 0.3, 0.9, 1.0}) {
    auto blended = one;
    blended.blend(start, share, random.split("blend"));
    EXPECT_NEAR(blended.mass_in(list), (1.0 - share) * one.mass_in(list) + share * start.mass_in(list),
                share > 0.0 ? 0.005 + 0.03 * share : 0.0);
    EXPECT_NEAR(total(blended.weights()), 1.0, 1e-12);
    const double before = blended.mass_in(list);
    blended.observe(list, HalfSpaceLikelihood{0.8}, random.split("after"));
    EXPECT_GE(blended.mass_in(list), before);
  }
  EXPECT_THROW(one.blend(start, 1.1, random), std::invalid_argument);
}

}  // namespace
}  // namespace kith
