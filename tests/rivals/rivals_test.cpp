// What is fast is the same as what is plain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "evidence.hpp"
#include "interaction.hpp"
#include "kith/domains/domain_file.hpp"
#include "naive_counterfactuals.hpp"
#include "naive_filter.hpp"

namespace kith::rivals {
namespace {

using ::testing::IsEmpty;

const Atlas& atlas() {
  static const Atlas made{load_domain("item-delivery")};
  return made;
}

TEST(NaiveFilter, IsABayesUpdate) {
  const std::vector<HalfSpace> seen{HalfSpace{{1, 0, 0}}};
  const ParticleBelief start{prior_cone(), {.resample_below = 0.0}};
  NaiveFilter filter{start, prior_half_spaces(), RandomStream{1}};
  const HalfSpaceLikelihood likelihood{0.8};
  filter.observe(seen, likelihood);
  double sum = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) sum += likelihood.density(start.point(i).x());
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_NEAR(filter.weights()[i], likelihood.density(start.point(i).x()) / sum, 1e-15);
}

TEST(NaiveFilter, GivesTheWeightsOfParticleBelief) {
  const Evidence evidence{3};
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief belief{prior_cone(), {.resample_below = 0.0}};
  NaiveFilter rival{belief, prior_half_spaces(), RandomStream{2}};
  for (int turn = 0; turn < 3; ++turn) {
    belief.observe(evidence.half_spaces, likelihood, RandomStream{2});
    rival.observe(evidence.half_spaces, likelihood);
  }
  for (std::size_t i = 0; i < belief.size(); ++i)
    EXPECT_NEAR(belief.weights()[i], rival.weights()[i], 1e-10 * rival.weights()[i]) << i;
}

// Points are drawn. The bounds are 5 standard errors: after one resampling of 1 000 points a mean direction is known to
// spread / sqrt(1000), a spread to about 1 / sqrt(1000) of it.
TEST(NaiveFilter, MovesPointsAsParticleBeliefDoes) {
  const Evidence evidence{3};
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief belief{prior_cone(), {.resample_below = 1.0}};
  NaiveFilter rival{belief, prior_half_spaces(), RandomStream{2}};
  belief.observe(evidence.half_spaces, likelihood, RandomStream{2});
  rival.observe(evidence.half_spaces, likelihood);
  const double n = std::sqrt(static_cast<double>(belief.size()));
  const double between = std::acos(std::clamp(belief.mean_direction().dot(rival.mean_direction()), -1.0, 1.0));
  EXPECT_LT(between, 5.0 * belief.spread() / n);
  EXPECT_NEAR(belief.spread() / rival.spread(), 1.0, 5.0 / n);
}

// The robot itself has nothing to learn; somebody who likes rubble has no finite optimum where there is any.
TEST(NaiveCounterfactuals, TellPeopleApart) {
  const NaiveCounterfactuals naive{atlas()};
  const std::vector<Eigen::Vector3d> robot{atlas().domain().weights().unit};
  for (const auto& list : naive.conveyed(robot)) ASSERT_THAT(list, IsEmpty());
  const std::vector<Eigen::Vector3d> hasty{Eigen::Vector3d{-0.1, 0.1, -1.0}.normalized()};
  std::size_t found = 0;
  for (const auto& list : naive.conveyed(hasty)) found += list.size();
  EXPECT_GT(found, 0u);
}

// Bit by bit, for every demonstration of the domain.
TEST(NaiveCounterfactuals, ConveyWhatTheAtlasLooksUp) {
  const Interaction interaction{atlas()};
  const NaiveCounterfactuals naive{atlas()};
  for (std::uint64_t turn = 0; turn < 2; ++turn) {
    const auto theirs = naive.conveyed(interaction.people(turn));
    const auto rows = atlas().tables().conveyed_by_class(interaction.cells(turn));
    for (StartIndex start{0}; start.value() < atlas().num_states(); ++start) {
      const auto row = std::span{rows}.subspan(atlas().start_class(start).value() * atlas().words_per_set(),
                                               atlas().words_per_set());
      ASSERT_EQ(atlas().constraints().half_spaces(ConstraintSet{row}), theirs[start.value()]) << start.value();
    }
  }
}

}  // namespace
}  // namespace kith::rivals
