#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "kith/analysis/effect.hpp"
#include "kith/analysis/study_power.hpp"
#include "small_study.hpp"

namespace kith {
namespace {

using testing::small_study;

TEST(ExamQuantities, HaveNamesThatEffectsAndTargetsUse) {
  const auto reading = small_study({});
  const auto effect = parse_effect("exam_regret: common - baseline", reading.study->variants.front());
  ASSERT_TRUE(effect.effect) << effect.problem;
  EXPECT_EQ(effect.effect->outcome, &outcome_named("exam_regret"));
  EXPECT_THAT(parse_effect("regret: strategy", reading.study->variants.front()).hint,
              ::testing::HasSubstr("exam_share_right, exam_regret, exam_worst_share_right"));
}

// Teams are examined only for quantities that need it, and that changes nothing else about them.
TEST(ExamQuantities, AreSimulatedWhereTheyAreNeeded) {
  const auto reading = small_study({"replicates=1"});
  const auto& spec = reading.study->variants.front();
  const Atlas atlas{*reading.domain};
  const std::array with{&outcome_named("periods"), &outcome_named("exam_regret")};
  const std::array without{&outcome_named("knowledge")};
  EXPECT_EQ(recording(spec, without).exam, ExamLevel::kNone);
  const auto plain = simulate_pools(atlas, Study{{recording(spec, without)}}, {.threads = 1, .on_progress = {}});
  const auto examined = simulate_pools(atlas, Study{{recording(spec, with)}}, {.threads = 1, .on_progress = {}});
  ASSERT_TRUE(plain && examined);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(plain->front().cell(outcome_named("knowledge"), s, 0)[0],
              examined->front().cell(outcome_named("knowledge"), s, 0)[0]);
    const double right = examined->front().cell(outcome_named("exam_share_right"), s, 0)[0];
    EXPECT_GT(right, 0.2);
    EXPECT_LE(examined->front().cell(outcome_named("exam_worst_share_right"), s, 0)[0], right);
    EXPECT_GE(examined->front().cell(outcome_named("exam_regret"), s, 0)[0], 0.0);
  }
  EXPECT_THROW((void)plain->front().cell(outcome_named("exam_regret"), 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
