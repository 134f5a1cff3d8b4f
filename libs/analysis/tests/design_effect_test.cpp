#include "kith/analysis/design_effect.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace kith {
namespace {

TEST(DesignEffect, EqualGroupsHaveOnePlusSizeLessOneTimesTheCorrelation) {
  const Factor teams{"team", {"a", "b", "c", "nobody"}, {0, 0, 0, 1, 1, 1, 2, 2, 2}};
  const auto effect = design_effect(teams, 0.6);
  ASSERT_TRUE(effect);
  EXPECT_EQ(effect->observations, 9u);
  EXPECT_EQ(effect->groups, 3u);
  EXPECT_DOUBLE_EQ(effect->mean_group_size, 3.0);
  EXPECT_DOUBLE_EQ(effect->weighted_group_size, 3.0);
  EXPECT_DOUBLE_EQ(effect->design_effect, 2.2);
  EXPECT_DOUBLE_EQ(effect->effective_observations, 9.0 / 2.2);
}

// The variance of the mean of groups of 1 and 3 with unit variances: (1 + 3 (1 + 2 icc)) / 16 in place of 4 / 16.
TEST(DesignEffect, UnequalGroupsWeighBySize) {
  const Factor teams{"team", {"a", "b"}, {0, 1, 1, 1}};
  const auto effect = design_effect(teams, 0.5);
  ASSERT_TRUE(effect);
  EXPECT_DOUBLE_EQ(effect->mean_group_size, 2.0);
  EXPECT_DOUBLE_EQ(effect->design_effect, (1.0 + 3.0 * (1.0 + 2.0 * 0.5)) / 4.0);
}

TEST(DesignEffect, IndependentRowsAndSingleRowsHaveNone) {
  const Factor teams{"team", {"a", "b"}, {0, 0, 1, 1}};
  EXPECT_DOUBLE_EQ(design_effect(teams, 0.0)->design_effect, 1.0);
  const Factor singles{"row", {"a", "b"}, {0, 1}};
  EXPECT_DOUBLE_EQ(design_effect(singles, 0.9)->effective_observations, 2.0);
}

TEST(DesignEffect, ImpossibleCorrelationsHaveAReason) {
  const Factor teams{"team", {"a"}, {0, 0, 0}};
  EXPECT_FALSE(design_effect(teams, -0.9));
  EXPECT_FALSE(design_effect(Factor{"team", {"a"}, {}}, 0.5));
  EXPECT_THROW((void)design_effect(teams, 1.5), std::invalid_argument);
}

}  // namespace
}  // namespace kith
