// Ordinary weights often make paths with different feature counts equally good.
// Everything that does not depend on such ties is still taught.

#include <gtest/gtest.h>

#include <string>

#include "item_delivery.hpp"
#include "kith/core/assert.hpp"

namespace kith {
namespace {

Atlas with_weights(const std::string& weights) {
  std::string text;
  for (const auto& domain : built_in_domains()) {
    if (domain.name == "item-delivery") text = domain.text;
  }
  const std::string published = "rubble = -3.0, recharge = 3.5, step = -1.0";
  const auto at = text.find(published);
  KITH_ASSERT(at != std::string::npos);
  return Atlas{parse_domain(text.replace(at, published.size(), weights), "ties.toml").domain.value()};
}

class Indifference : public ::testing::TestWithParam<const char*> {};

TEST_P(Indifference, LeavesARegionAroundTheRobotsWeights) {
  const auto atlas = with_weights(GetParam());
  auto everything = atlas.no_constraints();
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    everything.insert(c);
    EXPECT_GE(sign_of_dot(atlas.constraints()[c].normal(), atlas.domain().weights().integer), 0);
  }
  const auto region = Cone::intersection(atlas.constraints().half_spaces(everything));
  ASSERT_TRUE(region.has_value());
  EXPECT_TRUE(region->contains(atlas.domain().weights().integer));
  EXPECT_GT(atlas.policy_bec_area_sr(), 0.0);
  for (const auto& component : atlas.knowledge_components()) EXPECT_GT(component.area_sr, 0.0);
}

// In the policy's class everybody's answers are as good as the robot's.
TEST_P(Indifference, WeightsOfThePolicysClassActOptimally) {
  const auto atlas = with_weights(GetParam());
  const auto& weights = atlas.domain().weights().integer;
  auto bounds = atlas.policy_bec_half_spaces();
  for (const auto& half_space : atlas.domain().prior()) bounds.push_back(half_space);
  const auto bec = Cone::intersection(bounds);
  ASSERT_TRUE(bec.has_value());
  RandomStream random{31};
  for (int i = 0; i < 12; ++i) {
    const auto cell = atlas.tables().cells().locate(bec->sample(random));
    for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
      const auto answer = atlas.tables().answer(start, cell);
      ASSERT_TRUE(answer.has_value());
      ASSERT_EQ(sign_of_dot(weights, atlas.feature_counts(start) - *answer), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Weights, Indifference,
    ::testing::Values("rubble = -3.0, recharge = 3.5, step = -1.0", "rubble = -2.0, recharge = 3.5, step = -1.0",
                      "rubble = -1.5, recharge = 3.5, step = -1.0", "rubble = 0.0, recharge = 3.5, step = -1.0",
                      "rubble = -3.0, recharge = 3.0, step = -1.0", "rubble = -2.0, recharge = 2.0, step = -1.0",
                      "rubble = -4.0, recharge = 4.0, step = -2.0"));

}  // namespace
}  // namespace kith
