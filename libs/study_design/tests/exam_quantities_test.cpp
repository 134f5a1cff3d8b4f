#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "kith/study_design/effect.hpp"
#include "kith/study_design/power.hpp"
#include "small_study.hpp"

namespace kith {
namespace {

using testing::small_study;

TEST(ExamQuantities, HaveNamesThatEffectsAndTargetsUse) {
  for (std::size_t q = 0; q < kNumQuantities; ++q) {
    EXPECT_EQ(find_quantity(name_of(static_cast<Quantity>(q))), static_cast<Quantity>(q));
  }
  const auto reading = small_study({});
  const auto effect = parse_effect("exam_regret: common - baseline", reading.study->variants.front());
  ASSERT_TRUE(effect.effect) << effect.problem;
  EXPECT_EQ(effect.effect->quantity, Quantity::kExamRegret);
  EXPECT_THAT(parse_effect("regret: strategy", reading.study->variants.front()).hint,
              ::testing::HasSubstr("exam_share_right, exam_regret, exam_worst_share_right"));
}

// Teams are examined only for quantities that need it, and that changes nothing else about them.
TEST(ExamQuantities, AreSimulatedWhereTheyAreNeeded) {
  const auto reading = small_study({"replicates=1"});
  const auto& spec = reading.study->variants.front();
  const Atlas atlas{*reading.domain};
  const std::array with{Quantity::kPeriods, Quantity::kExamRegret};
  const std::array without{Quantity::kKnowledge};
  EXPECT_EQ(recording(spec, without).exam, ExamLevel::kNone);
  const auto plain = simulate_pools(atlas, Study{{recording(spec, without)}}, {.threads = 1, .on_progress = {}});
  const auto examined = simulate_pools(atlas, Study{{recording(spec, with)}}, {.threads = 1, .on_progress = {}});
  ASSERT_TRUE(plain && examined);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(plain->front().cell(Quantity::kKnowledge, s, 0)[0],
              examined->front().cell(Quantity::kKnowledge, s, 0)[0]);
    const double right = examined->front().cell(Quantity::kExamShareRight, s, 0)[0];
    EXPECT_GT(right, 0.2);
    EXPECT_LE(examined->front().cell(Quantity::kExamWorstShareRight, s, 0)[0], right);
    EXPECT_GE(examined->front().cell(Quantity::kExamRegret, s, 0)[0], 0.0);
  }
  EXPECT_THROW((void)plain->front().cell(Quantity::kExamRegret, 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
