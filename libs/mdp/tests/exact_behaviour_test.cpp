// behave() on deterministic, undiscounted processes with integer features, where its answers are exact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "small_mdps.hpp"

namespace kith {
namespace {

using testing::kNumRandom;
using testing::make_mdp;
using testing::random_weights;

TEST(BehaveExactly, EqualsPlanExactlyForIntegerWeights) {
  RandomStream random{13};
  int num_solved = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const IntegerVector weights = random_weights(random);
    const auto exact = plan_exactly(mdp, weights).solution;
    const auto real = behave(mdp, testing::to_real(weights));
    ASSERT_EQ(real.has_value(), exact.has_value());
    if (!exact) continue;
    ++num_solved;
    EXPECT_EQ(real->values, std::vector<double>(exact->values.begin(), exact->values.end()));
    EXPECT_EQ(real->choice, exact->canonical_choice);
    EXPECT_EQ(real->counts, exact->feature_counts);
  }
  EXPECT_GT(num_solved, 50);
}

// Thirds are not representable: ties survive rounding only through the tolerance.
TEST(BehaveExactly, SeesTheSameTiesWhateverTheLengthOfTheWeights) {
  RandomStream random{14};
  int num_ties = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const IntegerVector weights = random_weights(random);
    const auto exact = plan_exactly(mdp, weights).solution;
    auto scaled = testing::to_real(weights);
    for (double& w : scaled) w /= 3.0;
    const auto real = behave(mdp, scaled);
    ASSERT_EQ(real.has_value(), exact.has_value());
    if (!exact) continue;
    EXPECT_EQ(real->choice, exact->canonical_choice);
    EXPECT_EQ(real->counts, exact->feature_counts);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      for (std::size_t c = 0; c < mdp.choices(StateIndex{s}).size(); ++c) {
        const Outcome& step = testing::outcome(mdp, StateIndex{s}, c);
        const auto reward = static_cast<std::int64_t>(dot(weights, mdp.integer_features(step)));
        const bool is_best = reward + exact->values[step.next.value()] == exact->values[s];
        EXPECT_EQ(is_optimal(mdp, *real, scaled, StateIndex{s}, c), is_best);
        num_ties += is_best && c != real->choice[s] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(num_ties, 100);
}

TEST(BehaveExactly, TreatsALossBelowTheToleranceAsNone) {
  const Mdp mdp = testing::round_trip();
  EXPECT_TRUE(behave(mdp, std::vector{2.0 - 1e-6, -1.0}));
  EXPECT_FALSE(behave(mdp, std::vector{2.0 - 1e-12, -1.0}));
  EXPECT_TRUE(behave(mdp, std::vector{2.0 - 1e-12, -1.0}, {.tolerance = 0.0}));
}

TEST(BehaveExactly, RefusesBadWeights) {
  const Mdp mdp = testing::diamond();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)behave(mdp, std::vector{-1.0}), std::invalid_argument);
  EXPECT_THROW((void)behave(mdp, std::vector{-1.0, kNan}), std::invalid_argument);
  EXPECT_THROW((void)behave(mdp, std::vector{-1.0, -1.0}, {.tolerance = -1e-9}), std::invalid_argument);
}

TEST(BehaveInFavourExactly, PicksTheWayTheRobotLikesAmongTheLearnersBest) {
  const Mdp mdp = make_mdp(1, 1, {{0, 0, 1, {1, 0}}, {0, 1, 1, {0, 1}}, {0, 2, 1, {5, 0}}});
  const std::vector learner{-1.0, -1.0};
  const auto counts = [&](const std::vector<double>& robot) {
    return behave_in_favour(mdp, learner, robot).value().counts[0];
  };
  EXPECT_EQ(counts({0.0, 3.0}), (IntegerVector{0, 1}));
  EXPECT_EQ(counts({9.0, 3.0}), (IntegerVector{1, 0}));
  EXPECT_EQ(counts({3.0, 3.0}), (IntegerVector{1, 0}));
}

TEST(BehaveInFavourExactly, EqualsEnumerationOfAllOptimalTrajectories) {
  RandomStream random{15};
  int num_choices_open = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(6, random);
    const IntegerVector learner = random_weights(random);
    const IntegerVector robot = testing::random_vector(-9, 9, random);
    const auto found = behave_in_favour(mdp, testing::to_real(learner), testing::to_real(robot));
    ASSERT_EQ(found.has_value(), plan_exactly(mdp, learner).solution.has_value());
    if (!found) continue;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const IntegerVector& counts = found->counts[s];
      auto paths = testing::all_paths(mdp, s);
      const auto by_learner = [&](const IntegerVector& mu) { return dot(learner, mu); };
      const Int128 best = by_learner(*std::ranges::max_element(paths, {}, by_learner));
      std::erase_if(paths, [&](const IntegerVector& mu) { return by_learner(mu) < best; });
      const auto by_robot = [&](const IntegerVector& mu) { return dot(robot, mu); };
      EXPECT_TRUE(by_robot(*std::ranges::max_element(paths, {}, by_robot)) == by_robot(counts));
      EXPECT_THAT(paths, ::testing::Contains(counts));
      EXPECT_EQ(testing::roll_out(mdp, found->choice, s).features, counts);
      num_choices_open += by_robot(*std::ranges::min_element(paths, {}, by_robot)) < by_robot(counts) ? 1 : 0;
    }
  }
  EXPECT_GT(num_choices_open, 50);
}

}  // namespace
}  // namespace kith
