#include "kith/domains/judgement.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"

namespace kith {
namespace {

// Two equally good ways round the mud in the middle; the exit is two steps from the start's corner.
const std::string kTwoWays = testing::map_domain(
    "two-ways", "\"..G\", \".m.\", \"S..\"", "\"m\" = { terrain = \"mud\" }\n",
    {{"goal", "goal"}, {"mud", "enter:mud"}, {"step", "action"}}, "goal = 6, mud = -2.5, step = -0.5",
    "normalize = \"l1\"\n", "[mdp]\nactions = [\"up\", \"down\", \"left\", \"right\", \"exit\"]\n");

const Domain& two_ways() {
  static const Domain domain = sound_domain(kTwoWays);
  return domain;
}
const IntegerVector kRobot{1, 0, 4};

TEST(Judgement, CallsEveryBestPathRight) {
  const auto judged = judge_path(two_ways(), kRobot, {1, 0, 4});
  EXPECT_TRUE(judged.is_right);
  EXPECT_FALSE(judged.is_better);
  EXPECT_EQ(judged.regret, 0.0);
}

TEST(Judgement, SaysWhatADetourAndMudCost) {
  const auto detour = judge_path(two_ways(), kRobot, {1, 0, 6});
  EXPECT_FALSE(detour.is_right);
  EXPECT_DOUBLE_EQ(detour.raw_regret, 1.0);
  EXPECT_DOUBLE_EQ(detour.regret, 1.0 / 9.0);
  const auto mud = judge_path(two_ways(), kRobot, {1, 1, 4});
  EXPECT_DOUBLE_EQ(mud.raw_regret, 2.5);
  EXPECT_EQ(mud.loss, (IntegerVector{0, -1, 0}));
}

TEST(Judgement, FindsTheBetterPathIfTheRobotsIsNot) {
  const auto judged = judge_path(two_ways(), {1, 1, 4}, kRobot);
  EXPECT_TRUE(judged.is_right);
  EXPECT_TRUE(judged.is_better);
  EXPECT_LT(judged.regret, 0.0);
}

TEST(Judgement, RefusesCountsOfOtherFeatures) {
  EXPECT_THROW((void)judge_path(two_ways(), kRobot, {1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
