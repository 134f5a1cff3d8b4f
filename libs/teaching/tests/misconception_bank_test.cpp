#include "kith/teaching/misconception_bank.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "item_delivery.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {
namespace {

using testing::half_spaces;
using testing::item_delivery;

// "crossing rubble costs more than 2 steps".
const HalfSpace kRubble{{-1, 0, 2}};

class MisconceptionBankTest : public ::testing::Test {
 protected:
  [[nodiscard]] MisconceptionBank bank(double mended = 0.1) {
    MisconceptionBank::Options options;
    options.filter.particles = 200;
    options.mended = mended;
    return {item_delivery(), options, MisconceptionBank::beliefs(cache_, options, RandomStream{3})};
  }

  // A lesson about all of the first component, with a test of kRubble that somebody with these weights answers.
  [[nodiscard]] ObservedPeriod lesson(std::size_t number, const Direction& weights) {
    const auto& component = item_delivery().knowledge_components()[0];
    const auto shown = item_delivery().constraints().half_spaces(component.constraints);
    const auto start = item_delivery().tests_for(*item_delivery().constraints().find(kRubble)).front();
    const auto answer = cache_.behaviours().answer(start, cache_.behaviours().locate(weights));
    const bool is_right = answer == item_delivery().feature_counts(start);
    ObservedPeriod period;
    period.period = number;
    period.component = 0;
    period.demonstrations.push_back({.start = start, .half_spaces = shown, .counterfactuals = {}});
    period.tests.push_back({.start = start, .covered = {kRubble}});
    period.answers.push_back(answer);
    period.verdicts.push_back({.correct = is_right, .half_spaces = {}});
    period.all_correct = is_right;
    period.feedback = shown;
    return period;
  }

  // Weights of length 1.
  [[nodiscard]] static Direction weights(double rubble, double charger, double step) {
    Direction w(3);
    w << rubble, charger, step;
    return w / w.norm();
  }

  [[nodiscard]] std::size_t position(const MisconceptionBank& bank) const {
    const auto constraints = bank.constraints();
    return static_cast<std::size_t>(std::find(constraints.begin(), constraints.end(), kRubble) - constraints.begin());
  }

  TeachingCache cache_{item_delivery()};
  const Direction robot_ = weights(-3.0, 3.5, -1.0);
  const Direction cheap_rubble_ = weights(-1.2, 3.5, -1.0);
};

TEST_F(MisconceptionBankTest, KnowsTheConstraintsThatPeopleMayGetWrong) {
  EXPECT_EQ(constraints_to_learn(item_delivery()),
            half_spaces({{-1, 0, 2}, {0, -1, -4}, {0, 1, 2}, {1, 0, -4}, {1, 1, 0}}));
  const auto one = bank();
  ASSERT_EQ(one.constraints().size(), 5u);
  // A fifth of nine tenths: one in ten does not learn.
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(one.probability_of_misconception(j), 0.036, 1e-12);
  EXPECT_NEAR(one.probability_of_learning(), 0.9, 1e-12);
}

TEST_F(MisconceptionBankTest, FindsAMisconceptionThatLessonsDoNotMend) {
  auto one = bank();
  const auto j = position(one);
  double before = one.probability_of_misconception(j);
  for (std::size_t period = 1; period <= 4; ++period) {
    one.observe(item_delivery(), lesson(period, cheap_rubble_));
    EXPECT_GT(one.probability_of_misconception(j), before);
    before = one.probability_of_misconception(j);
  }
  EXPECT_LT(one.probability_of({&kRubble, 1}), 0.2);
}

TEST_F(MisconceptionBankTest, RulesMisconceptionsOutByRightAnswers) {
  auto one = bank(0.0);
  for (std::size_t period = 1; period <= 4; ++period) one.observe(item_delivery(), lesson(period, robot_));
  EXPECT_LT(one.probability_of_misconception(position(one)), 0.001);
  EXPECT_GT(one.probability_of({&kRubble, 1}), 0.9);
}

TEST_F(MisconceptionBankTest, BelievesThatFeedbackMayMendAMisconception) {
  auto stubborn = bank(0.0);
  auto ordinary = bank(0.5);
  for (std::size_t period = 1; period <= 3; ++period) {
    stubborn.observe(item_delivery(), lesson(period, cheap_rubble_));
    ordinary.observe(item_delivery(), lesson(period, cheap_rubble_));
  }
  EXPECT_GT(stubborn.probability_of_misconception(position(stubborn)),
            ordinary.probability_of_misconception(position(ordinary)) + 0.1);
}

// It is as likely with any of them, and makes all of them less probable than guessing.
TEST_F(MisconceptionBankTest, LearnsOfNoMisconceptionFromTestsWithoutAnswers) {
  auto silent = lesson(1, cheap_rubble_);
  silent.answers.front().reset();
  silent.verdicts.front().answered = false;
  auto one = bank(0.0);
  one.observe(item_delivery(), silent);
  for (std::size_t j = 0; j < 5; ++j) {
    EXPECT_NEAR(one.probability_of_misconception(j), one.probability_of_misconception(position(one)), 1e-12);
  }
  EXPECT_LT(one.probability_of_misconception(position(one)), 0.036);
}

TEST_F(MisconceptionBankTest, ForgetsWithTime) {
  auto one = bank();
  for (std::size_t period = 1; period <= 4; ++period) one.observe(item_delivery(), lesson(period, robot_));
  const std::vector<std::vector<HalfSpace>> lists{{kRubble}};
  const auto after = [&](double angle) {
    double sum = 0.0, all = 0.0;
    const auto later = one.shares_after(angle, lists, RandomStream{1});
    for (const auto& [weight, share] : later.front()) {
      sum += weight * share;
      all += weight;
    }
    EXPECT_NEAR(all, 1.0, 1e-5);
    return sum;
  };
  EXPECT_NEAR(after(0.0), one.probability_of({&kRubble, 1}), 1e-9);
  EXPECT_LT(after(0.4), after(0.0));
}

// In any order of asking, and whatever the others answered.
TEST_F(MisconceptionBankTest, SharesBeliefsAmongPeopleWithTheSameLessons) {
  MisconceptionBank::Options options;
  options.filter.particles = 200;
  const auto beliefs = MisconceptionBank::beliefs(cache_, options, RandomStream{3});
  MisconceptionBank right{item_delivery(), options, beliefs}, wrong{item_delivery(), options, beliefs};
  auto alone = bank();
  for (std::size_t period = 1; period <= 3; ++period) right.observe(item_delivery(), lesson(period, robot_));
  for (std::size_t period = 1; period <= 3; ++period) wrong.observe(item_delivery(), lesson(period, cheap_rubble_));
  for (std::size_t period = 1; period <= 3; ++period) alone.observe(item_delivery(), lesson(period, cheap_rubble_));
  EXPECT_EQ(wrong.probability_of({&kRubble, 1}), alone.probability_of({&kRubble, 1}));
  EXPECT_EQ(wrong.probability_of_learning(), alone.probability_of_learning());
  EXPECT_GT(right.probability_of({&kRubble, 1}), wrong.probability_of({&kRubble, 1}));
  MisconceptionBank other{item_delivery(), options, beliefs};
  EXPECT_THROW(other.observe(item_delivery(), lesson(2, robot_)), std::invalid_argument);
}

// Nobody can have stopped in the first period. Later, right answers speak against it and wrong ones for it.
TEST_F(MisconceptionBankTest, TellsWhoLearnsFromWhoStopped) {
  auto learns = bank(), stopped = bank();
  const std::vector<HalfSpace> rubble{kRubble};
  learns.observe(item_delivery(), lesson(1, robot_));
  EXPECT_EQ(learns.odds_against_stopping(rubble, {}), std::numeric_limits<double>::infinity());
  stopped.observe(item_delivery(), lesson(1, cheap_rubble_));
  for (std::size_t period = 2; period <= 4; ++period) {
    learns.observe(item_delivery(), lesson(period, robot_));
    stopped.observe(item_delivery(), lesson(period, cheap_rubble_));
  }
  EXPECT_GT(learns.odds_against_stopping(rubble, {}), 1.0);
  EXPECT_LT(stopped.odds_against_stopping(rubble, {}), 0.5);
  EXPECT_LT(stopped.probability_of_learning(), learns.probability_of_learning());
}

TEST_F(MisconceptionBankTest, DrawsWeightsThatViolateAConstraint) {
  const auto drawn = bank().violators(kRubble, 8);
  ASSERT_FALSE(drawn.empty());
  EXPECT_LE(drawn.size(), 8u);
  for (const auto& weights : drawn) EXPECT_FALSE(kRubble.contains(weights));
}

TEST_F(MisconceptionBankTest, RefusesWhatIsOutOfRange) {
  MisconceptionBank::Options options;
  options.misconceived = 1.0;
  const auto beliefs = MisconceptionBank::beliefs(cache_, options, RandomStream{1});
  EXPECT_THROW(MisconceptionBank(item_delivery(), options, beliefs), std::invalid_argument);
  options.misconceived = 0.1;
  options.mended = 1.5;
  EXPECT_THROW(MisconceptionBank(item_delivery(), options, beliefs), std::invalid_argument);
}

// As of somebody who stops short, or is late.
TEST_F(MisconceptionBankTest, TakesATestWithoutAnAnswerForAWrongOne) {
  auto answering = bank(), silent = bank();
  for (std::size_t number = 1; number <= 4; ++number) {
    auto period = lesson(number, weights(-1.0, 1.1, -0.32));
    answering.observe(item_delivery(), period);
    period.answers.clear();
    period.verdicts.front() = {.correct = false, .answered = false, .half_spaces = {}};
    silent.observe(item_delivery(), period);
  }
  EXPECT_EQ(silent.agreement().tests, 4u);
  EXPECT_EQ(silent.agreement().right, 0u);
  EXPECT_LT(silent.odds_of_learning(), answering.odds_of_learning());
  EXPECT_LT(silent.probability_of_learning(), answering.probability_of_learning());
}

}  // namespace
}  // namespace kith
