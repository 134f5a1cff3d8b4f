// Exact facts of the built-in domains other than item delivery, and the laws that hold in all of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kith/bec/atlas.hpp"
#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/coverage_set.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

const Atlas& atlas_of(const std::string& name) {
  static std::map<std::string, Atlas> made;
  if (const auto found = made.find(name); found != made.end()) return found->second;
  return made.emplace(name, Atlas{load_domain(name)}).first->second;
}

HalfSpace half_space(std::int64_t a, std::int64_t b, std::int64_t c) { return HalfSpace{IntegerVector{a, b, c}}; }

std::vector<HalfSpace> constraints_of(const Atlas& atlas, const KnowledgeComponent& component) {
  return atlas.constraints().half_spaces(component.constraints);
}

TEST(ColoredTiles, HasThePublishedFamily) {
  const auto& atlas = atlas_of("colored-tiles");
  EXPECT_EQ(atlas.domain().num_mdps(), 512u);
  EXPECT_EQ(atlas.num_states(), 12'288u);
  for (std::size_t m = 0; m < 512; ++m) EXPECT_EQ(atlas.domain().mdp(MdpIndex{m}).num_states(), 24u);
}

TEST(ColoredTiles, TeachesTheKnownRegionInTheKnownOrder) {
  const auto& atlas = atlas_of("colored-tiles");
  EXPECT_THAT(atlas.policy_bec_half_spaces(),
              ElementsAre(half_space(-1, 0, 6), half_space(0, 1, -6), half_space(1, -1, -2)));
  EXPECT_NEAR(atlas.policy_bec_area_sr(), 0.00322492, 5e-9);
  EXPECT_THAT(atlas.mask_counters(), ElementsAre(10'939u, 8'975u, 21'278u));
  const auto& components = atlas.knowledge_components();
  ASSERT_EQ(components.size(), 3u);
  EXPECT_THAT(constraints_of(atlas, components[0]), ElementsAre(half_space(-1, 0, 6), half_space(1, 0, -8)));
  EXPECT_THAT(constraints_of(atlas, components[1]), ElementsAre(half_space(0, -1, 4), half_space(0, 1, -6)));
  EXPECT_NEAR(components[0].area_sr, 0.081587, 5e-7);
  EXPECT_NEAR(components[1].area_sr, 0.159660, 5e-7);
}

TEST(ColoredTiles, HasTheKnownCoverageSets) {
  const auto& coverage = atlas_of("colored-tiles").tables().coverage();
  EXPECT_EQ(coverage.vertices, 31'536u);
  EXPECT_NEAR(coverage.mean, 2.57, 0.005);
  EXPECT_EQ(coverage.max, 8u);
}

TEST(Skateboard, HasThePublishedFamily) {
  const auto& domain = atlas_of("skateboard").domain();
  std::vector<std::size_t> states;
  for (std::size_t m = 0; m < domain.num_mdps(); ++m) states.push_back(domain.mdp(MdpIndex{m}).num_states());
  EXPECT_THAT(states, UnorderedElementsAre(23u, 23u, 23u, 23u, 552u, 456u, 456u, 360u));
  EXPECT_EQ(domain.num_starts(), 1'916u);
}

// Two optimal paths with different features: the robot's weights lie on the boundary of what can be taught.
TEST(Skateboard, TeachesTheKnownRegionWithTheRobotOnItsBoundary) {
  const auto& atlas = atlas_of("skateboard");
  EXPECT_THAT(atlas.policy_bec_half_spaces(),
              ElementsAre(half_space(-9, 1, 1), half_space(-4, 5, -2), half_space(5, 2, -2), half_space(6, -4, 1)));
  EXPECT_NEAR(atlas.policy_bec_area_sr(), 0.000281747, 5e-10);
  std::vector<double> margins;
  const auto& raw = atlas.domain().weights().raw;
  for (const auto& h : atlas.policy_bec_half_spaces()) {
    double margin = 0.0;
    for (std::size_t k = 0; k < 3; ++k) margin += static_cast<double>(h.normal()[k]) * raw[k];
    margins.push_back(margin);
  }
  const std::vector<double> expected{0.0625, 0.1375, 0.1, 0.0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(margins[i], expected[i], 1e-12);
  EXPECT_EQ(sign_of_dot(half_space(6, -4, 1).normal(), atlas.domain().weights().integer), 0);
}

// The best return over a start's coverage set is what planning finds, for weights that have an optimum somewhere.
void expect_hull_maximum_is_the_plan(const Atlas& atlas, int num_weights, std::uint64_t seed) {
  const auto& domain = atlas.domain();
  RandomStream random{seed};
  int used = 0;
  for (int i = 0; used < num_weights && i < 100 * num_weights; ++i) {
    const auto direction = Cone{}.sample(random);
    const std::vector<double> weights{direction[0], direction[1], direction[2]};
    bool has_optimum = false;
    for (std::size_t m = 0; m < domain.num_mdps(); ++m) {
      const auto solution = behave(domain.mdp(MdpIndex{m}), weights);
      if (!solution) continue;
      has_optimum = true;
      for (std::size_t s = 0; s < domain.mdp(MdpIndex{m}).num_states(); ++s) {
        const auto start = atlas.index({MdpIndex{m}, StateIndex{s}});
        double best = -std::numeric_limits<double>::infinity();
        for (const auto& mu : atlas.tables().coverage_set(start)) {
          double value = 0.0;
          for (std::size_t k = 0; k < 3; ++k) value += static_cast<double>(mu[k]) * weights[k];
          best = std::max(best, value);
        }
        ASSERT_NEAR(best, solution->values[s], 1e-9 * std::max(1.0, std::abs(best)))
            << domain.id() << ", MDP " << m << ", state " << s << ", weights " << direction.transpose();
      }
    }
    used += has_optimum ? 1 : 0;
  }
  EXPECT_EQ(used, num_weights);
}

class EveryBuiltInDomain : public ::testing::TestWithParam<std::string> {};
class EveryBuiltInDomainSlow : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryBuiltInDomain, HullMaximumIsTheOptimalValue) {
  expect_hull_maximum_is_the_plan(atlas_of(GetParam()), 1, 7);
}
TEST_P(EveryBuiltInDomainSlow, HullMaximumIsTheOptimalValue) {
  expect_hull_maximum_is_the_plan(atlas_of(GetParam()), 200, 8);
}

TEST_P(EveryBuiltInDomain, EveryConstraintHoldsAtTheRobotsWeights) {
  const auto& atlas = atlas_of(GetParam());
  const auto& w = atlas.domain().weights().integer;
  for (std::size_t c = 0; c < atlas.constraints().size(); ++c) {
    EXPECT_GE(sign_of_dot(atlas.constraints()[ConstraintIndex{c}].normal(), w), 0) << c;
  }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& domain) {
  std::string name = domain.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
const auto kOthers = ::testing::Values("colored-tiles", "skateboard", "two-goals", "cookie-crumb");
INSTANTIATE_TEST_SUITE_P(All, EveryBuiltInDomain, kOthers, test_name);
INSTANTIATE_TEST_SUITE_P(All, EveryBuiltInDomainSlow, kOthers, test_name);

// Each feature, each pair and all of them would be 22.
TEST(Navigation, IsTaughtInFewPartsThatFollowFromThePolicy) {
  const auto& atlas = atlas_of("navigation");
  const auto& components = atlas.knowledge_components();
  EXPECT_GE(components.size(), 4u);
  EXPECT_LE(components.size(), 9u);  // d + 2
  EXPECT_EQ(components.back().features.size(), 6u);
  EXPECT_EQ(components.back().constraints, atlas.policy_bec());
  Regions regions{atlas.constraints()};
  auto taught = atlas.prior();
  for (const auto& component : components) {
    const auto after = regions.minimal(taught | component.constraints);
    EXPECT_FALSE(after == taught) << component.name << " has nothing to teach";
    taught = after;
    const auto& domain = atlas.domain();
    bool has_world = false;
    for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
      has_world = has_world || (component.uses_mdp[m.value()] &&
                                std::all_of(component.features.begin(), component.features.end(),
                                            [&](std::size_t k) { return domain.mdp(m).has_feature(k); }));
    }
    EXPECT_TRUE(has_world) << component.name;
  }
}

}  // namespace
}  // namespace kith
