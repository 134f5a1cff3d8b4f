#include "kith/teaching/observed_period.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

TEST(ObservedPeriods, LeaveOutPeriodsInWhichTheMemberWasAway) {
  const HalfSpace taught{{-1, 0, 2}};
  PastPeriod both;
  both.lesson.period = 1;
  both.lesson.component = 2;
  both.lesson.tests.push_back({.start = StartIndex{7}, .covered = {taught}});
  both.answers = {{IntegerVector{0, 0, 3}}, {std::nullopt}};
  both.feedback.verdicts = {{Verdict{.correct = true, .half_spaces = {}}},
                            {Verdict{.answered = false, .half_spaces = {}}}};
  both.feedback.all_correct = {true, false};
  both.feedback.half_spaces = {taught};
  PastPeriod first_only = both;
  first_only.lesson.period = 2;
  first_only.answers[1].clear();
  first_only.feedback.verdicts[1].clear();
  PastPeriods history;
  for (const auto& period : {both, first_only}) history.push_back(std::make_shared<const PastPeriod>(period));

  const auto first = observed_periods(history, 0);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[1].period, 2u);
  EXPECT_EQ(first[0].component, 2u);
  EXPECT_EQ(first[0].tests, both.lesson.tests);
  EXPECT_EQ(first[0].answers, both.answers[0]);
  EXPECT_TRUE(first[0].all_correct);
  EXPECT_EQ(first[0].feedback, both.feedback.half_spaces);

  const auto second = observed_periods(history, 1);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].period, 1u);
  EXPECT_FALSE(second[0].verdicts.front().answered);
}

}  // namespace
}  // namespace kith
