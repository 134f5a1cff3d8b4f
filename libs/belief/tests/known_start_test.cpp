// Beliefs of people who know the robot as it was before.
#include <gtest/gtest.h>

#include "kith/belief/particle_belief.hpp"

namespace kith {
namespace {

Cone cone_of(const std::vector<IntegerVector>& normals, std::size_t dimension) {
  Cone cone{dimension};
  for (const auto& normal : normals) EXPECT_TRUE(cone.clip(HalfSpace{normal}));
  return cone;
}

TEST(KnownStart, HasItsMassInWhatIsKnownAndSomeEverywhere) {
  const auto prior = cone_of({{0, 0, -1}}, 3);
  const auto known = cone_of({{0, 0, -1}, {-1, 0, 2}, {0, -1, -4}, {1, 1, 0}}, 3);
  for (const std::size_t particles : {2u, 999u, 1000u}) {
    const ParticleBelief belief{PriorCover{prior, particles, {}, known}, {.particles = particles}};
    const double inside = belief.mass_in(known.minimal_set());
    EXPECT_GE(inside, 1.0 - kBeyondKnown - 1e-9);
    EXPECT_LT(inside, 1.0);
    EXPECT_NEAR(belief.mass_in(prior.minimal_set()), 1.0, 1e-12);
    EXPECT_GT(belief.effective_sample_size(), 0.5 * static_cast<double>(particles));  // else it were resampled at once
  }
}

TEST(KnownStart, IsThePriorForOneParticleOrWithoutAnythingKnown) {
  const auto prior = cone_of({{0, 0, -1}}, 3);
  const auto known = cone_of({{0, 0, -1}, {-1, 0, 2}}, 3);
  EXPECT_EQ((PriorCover{prior, 1, {}, known}.points()), (PriorCover{prior, 1}.points()));
  EXPECT_TRUE((PriorCover{prior, 100}.weights().empty()));
}

// Whatever is true keeps a share of kBeyondKnown / (d + 1) of its mass, so evidence outweighs what was known.
TEST(KnownStart, GivesWayToEvidenceAgainstIt) {
  for (const std::size_t d : {3u, 5u}) {
    IntegerVector up(d), side(d);
    up[0] = 1;
    side[1] = 1;
    const auto prior = cone_of({up}, d);
    const auto known = cone_of({up, side}, d);
    ParticleBelief belief{PriorCover{prior, 1000, {}, known}, {.particles = 1000}};
    const std::vector<HalfSpace> truth{HalfSpace{side}.opposite()};
    EXPECT_GT(belief.mass_in(truth), 0.3 * kBeyondKnown / static_cast<double>(d + 1));
    for (std::uint64_t i = 0; i < 8; ++i) belief.observe(truth, HalfSpaceLikelihood{0.8, {}, d}, RandomStream{i});
    EXPECT_GT(belief.mass_in(truth), 0.95) << d;
  }
}

}  // namespace
}  // namespace kith
