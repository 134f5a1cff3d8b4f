#include "kith/mdp/planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "small_mdps.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using testing::make_mdp;

constexpr int kNumRandom = 3000;

// 0 -> {1, 2} -> terminal 3; both ways cost the same.
Mdp diamond() { return make_mdp(3, 1, {{0, 1, 2, {0, 1}}, {0, 2, 1, {1, 0}}, {1, 0, 3, {0, 1}}, {2, 0, 3, {1, 0}}}); }

TEST(PlanExactly, AddsUpAChain) {
  const Mdp chain = make_mdp(3, 1, {{0, 0, 1, {1, 0}}, {1, 0, 2, {0, 1}}, {2, 0, 3, {1, 1}}});
  const ExactPlan plan = plan_exactly(chain, {-2, 5});
  ASSERT_TRUE(plan.solution);
  EXPECT_FALSE(plan.failure);
  EXPECT_THAT(plan.solution->values, ElementsAre(6, 8, 3, 0));
  EXPECT_THAT(plan.solution->feature_counts,
              ElementsAre(IntegerVector{2, 2}, IntegerVector{1, 2}, IntegerVector{1, 1}, IntegerVector{0, 0}));
}

TEST(PlanExactly, TakesTheFirstOfEqualActionsInActionOrder) {
  const ExactPlan plan = plan_exactly(diamond(), {-1, -1});
  ASSERT_TRUE(plan.solution);
  EXPECT_EQ(plan.solution->canonical_choice[0], 0u);
  EXPECT_EQ(canonical_trajectory(diamond(), plan.solution->canonical_choice, StateIndex{0}),
            (Trajectory{{StateIndex{0}, StateIndex{2}, StateIndex{3}}, {ActionIndex{1}, ActionIndex{0}}}));
}

// 0 <-> 1 -> terminal 2; the round trip has features (1, 2).
Mdp round_trip() { return make_mdp(2, 1, {{0, 0, 1, {1, 1}}, {1, 0, 0, {0, 1}}, {1, 1, 2, {0, 1}}}); }

TEST(PlanExactly, NamesAPositiveCycle) {
  const ExactPlan plan = plan_exactly(round_trip(), {3, -1});
  EXPECT_FALSE(plan.solution);
  EXPECT_EQ(plan.failure, PlanFailure::kPositiveCycle);
  EXPECT_THAT(plan.cycle, ::testing::UnorderedElementsAre(StateIndex{0}, StateIndex{1}));
}

TEST(PlanExactly, NamesAZeroCycle) {
  const ExactPlan plan = plan_exactly(round_trip(), {2, -1});
  EXPECT_FALSE(plan.solution);
  EXPECT_EQ(plan.failure, PlanFailure::kZeroCycle);
  EXPECT_THAT(plan.cycle, ::testing::UnorderedElementsAre(StateIndex{0}, StateIndex{1}));
}

TEST(PlanExactly, SolvesWhereTheCycleLosesByTheLeast) {
  const ExactPlan plan = plan_exactly(round_trip(), {1'999'999'999, -1'000'000'000});
  ASSERT_TRUE(plan.solution);
  EXPECT_THAT(plan.solution->values, ElementsAre(-1, -1'000'000'000, 0));
}

TEST(PlanExactly, NamesADeadEnd) {
  const Mdp mdp = make_mdp(3, 1, {{0, 0, 1, {1}}, {0, 1, 3, {1}}, {2, 0, 3, {1}}});
  const ExactPlan plan = plan_exactly(mdp, {-1});
  EXPECT_EQ(plan.failure, PlanFailure::kNoTerminal);
  EXPECT_THAT(plan.cycle, ElementsAre(StateIndex{1}));
}

TEST(PlanExactly, RefusesWhatItCannotSolveExactly) {
  EXPECT_THROW((void)plan_exactly(diamond(), {-1}), std::invalid_argument);
  EXPECT_THROW((void)plan_exactly(diamond(), {std::int64_t{1} << 61, -1}), std::invalid_argument);
  EXPECT_THROW((void)plan_exactly(make_mdp(1, 1, {{0, 0, 1, {0.5}}}), {-1}), std::invalid_argument);
  EXPECT_THROW((void)plan_exactly(make_mdp(1, 1, {{0, 0, 1, {1}}}, 0.9), {-1}), std::invalid_argument);
  MdpBuilder builder{1, 2, 1, 1, 1.0};
  const std::vector<MdpBuilder::Transition> coin{{StateIndex{1}, 0.5, {1}}, {StateIndex{2}, 0.5, {1}}};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, coin);
  EXPECT_THROW((void)plan_exactly(std::move(builder).build(), {-1}), std::invalid_argument);
}

// What enumerating all policies says about a process and its weights.
struct BruteForce {
  std::optional<PlanFailure> failure;
  std::vector<std::int64_t> values;
};

BruteForce enumerate_policies(const Mdp& mdp, const IntegerVector& weights) {
  BruteForce result;
  std::vector<std::optional<std::int64_t>> best(mdp.num_states());
  bool gains = false;
  bool costs_nothing = false;
  testing::for_each_policy(mdp, [&](const std::vector<std::uint32_t>& policy) {
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const auto rollout = testing::roll_out(mdp, policy, s);
      const auto reward = static_cast<std::int64_t>(dot(weights, rollout.features));
      if (rollout.finishes) {
        best[s] = std::max(best[s].value_or(reward), reward);
      } else if (!rollout.is_stuck) {
        gains = gains || reward > 0;
        costs_nothing = costs_nothing || reward == 0;
      }
    }
  });
  for (const auto& value : best) {
    if (!value) result.failure = PlanFailure::kNoTerminal;
    result.values.push_back(value.value_or(0));
  }
  if (!result.failure && gains) result.failure = PlanFailure::kPositiveCycle;
  if (!result.failure && costs_nothing) result.failure = PlanFailure::kZeroCycle;
  result.values.resize(mdp.num_states() + mdp.num_terminals(), 0);
  return result;
}

IntegerVector random_weights(RandomStream& random) {
  return {testing::uniform_integer(-4, 2, random), testing::uniform_integer(-4, 4, random),
          testing::uniform_integer(-6, 1, random)};
}

std::int64_t reward_of_cycle(const Mdp& mdp, const std::vector<StateIndex>& cycle, const IntegerVector& weights) {
  // The best edge between each two neighbours; a positive or zero cycle uses no worse ones.
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    std::optional<std::int64_t> best;
    for (std::size_t c = 0; c < mdp.choices(cycle[i]).size(); ++c) {
      const Outcome& step = testing::outcome(mdp, cycle[i], c);
      if (step.next != cycle[(i + 1) % cycle.size()]) continue;
      const auto reward = static_cast<std::int64_t>(dot(weights, mdp.integer_features(step)));
      best = std::max(best.value_or(reward), reward);
    }
    sum += best.value();  // throws if the states are not neighbours
  }
  return sum;
}

TEST(PlanExactly, EqualsBruteForceOverPolicies) {
  RandomStream random{11};
  std::map<std::optional<PlanFailure>, int> seen;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(5, random);
    const IntegerVector weights = random_weights(random);
    const BruteForce expected = enumerate_policies(mdp, weights);
    const ExactPlan plan = plan_exactly(mdp, weights);
    ASSERT_EQ(plan.failure, expected.failure);
    ASSERT_EQ(plan.solution.has_value(), !expected.failure.has_value());
    ++seen[plan.failure];
    if (plan.solution) {
      ASSERT_EQ(plan.solution->values, expected.values);
    }
    if (plan.failure == PlanFailure::kPositiveCycle) {
      EXPECT_GT(reward_of_cycle(mdp, plan.cycle, weights), 0);
    }
    if (plan.failure == PlanFailure::kZeroCycle) {
      EXPECT_EQ(reward_of_cycle(mdp, plan.cycle, weights), 0);
    }
    if (plan.failure == PlanFailure::kNoTerminal) {
      EXPECT_THAT(mdp.by_distance(), ::testing::Not(::testing::Contains(plan.cycle.at(0))));
    }
  }
  EXPECT_GT(seen[std::nullopt], 50);
  EXPECT_GT(seen[PlanFailure::kPositiveCycle], 50);
  EXPECT_GT(seen[PlanFailure::kZeroCycle], 20);
  EXPECT_GT(seen[PlanFailure::kNoTerminal], 50);
}

TEST(PlanExactly, TakesTheFirstOptimalChoiceInEveryState) {
  RandomStream random{12};
  int num_ties = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(6, random);
    const IntegerVector weights = random_weights(random);
    const auto solution = plan_exactly(mdp, weights).solution;
    if (!solution) continue;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      std::vector<std::uint32_t> optimal;
      for (std::uint32_t c = 0; c < mdp.choices(StateIndex{s}).size(); ++c) {
        const Outcome& step = testing::outcome(mdp, StateIndex{s}, c);
        const auto reward = static_cast<std::int64_t>(dot(weights, mdp.integer_features(step)));
        if (reward + solution->values[step.next.value()] == solution->values[s]) optimal.push_back(c);
      }
      ASSERT_FALSE(optimal.empty());
      EXPECT_EQ(solution->canonical_choice[s], optimal.front());
      num_ties += optimal.size() > 1 ? 1 : 0;
      const auto rollout = testing::roll_out(mdp, solution->canonical_choice, s);
      EXPECT_TRUE(rollout.finishes);
      EXPECT_EQ(solution->feature_counts[s], rollout.features);
      EXPECT_EQ(static_cast<std::int64_t>(dot(weights, rollout.features)), solution->values[s]);
    }
  }
  EXPECT_GT(num_ties, 100);
}

TEST(CanonicalTrajectory, EndsAtOnceWhereItStartsFinished) {
  EXPECT_EQ(canonical_trajectory(diamond(), std::vector<std::uint32_t>{0, 0, 0}, StateIndex{3}),
            (Trajectory{{StateIndex{3}}, {}}));
}

TEST(CanonicalTrajectory, RefusesChoicesThatDoNotFinishOrDoNotExist) {
  const Mdp mdp = round_trip();
  EXPECT_THROW((void)canonical_trajectory(mdp, std::vector<std::uint32_t>{0, 0}, StateIndex{0}), std::invalid_argument);
  EXPECT_THROW((void)canonical_trajectory(mdp, std::vector<std::uint32_t>{1, 1}, StateIndex{0}), std::invalid_argument);
  EXPECT_THROW((void)canonical_trajectory(mdp, std::vector<std::uint32_t>{0}, StateIndex{0}), std::invalid_argument);
  EXPECT_THROW((void)canonical_trajectory(mdp, std::vector<std::uint32_t>{0, 1}, StateIndex{3}), std::invalid_argument);
}

TEST(Plan, EqualsPlanExactlyForIntegerWeights) {
  RandomStream random{13};
  int num_solved = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const IntegerVector weights = random_weights(random);
    const auto exact = plan_exactly(mdp, weights).solution;
    const auto real = plan(mdp, testing::to_real(weights));
    ASSERT_EQ(real.has_value(), exact.has_value());
    if (!exact) continue;
    ++num_solved;
    EXPECT_EQ(real->values, std::vector<double>(exact->values.begin(), exact->values.end()));
    EXPECT_EQ(real->canonical_choice, exact->canonical_choice);
    EXPECT_EQ(real->feature_counts, exact->feature_counts);
  }
  EXPECT_GT(num_solved, 50);
}

// Thirds are not representable: ties survive rounding only through the tolerance.
TEST(Plan, SeesTheSameTiesWhateverTheLengthOfTheWeights) {
  RandomStream random{14};
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const IntegerVector weights = random_weights(random);
    const auto exact = plan_exactly(mdp, weights).solution;
    auto scaled = testing::to_real(weights);
    for (double& w : scaled) w /= 3.0;
    const auto real = plan(mdp, scaled);
    ASSERT_EQ(real.has_value(), exact.has_value());
    if (!exact) continue;
    EXPECT_EQ(real->canonical_choice, exact->canonical_choice);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      for (std::size_t c = 0; c < mdp.choices(StateIndex{s}).size(); ++c) {
        const Outcome& step = testing::outcome(mdp, StateIndex{s}, c);
        const auto reward = static_cast<std::int64_t>(dot(weights, mdp.integer_features(step)));
        EXPECT_EQ(is_optimal_choice(mdp, *real, scaled, StateIndex{s}, c),
                  reward + exact->values[step.next.value()] == exact->values[s]);
      }
    }
  }
}

TEST(Plan, TreatsALossBelowTheToleranceAsNone) {
  const Mdp mdp = round_trip();
  EXPECT_TRUE(plan(mdp, std::vector{2.0 - 1e-6, -1.0}));
  EXPECT_FALSE(plan(mdp, std::vector{2.0 - 1e-12, -1.0}));
  EXPECT_TRUE(plan(mdp, std::vector{2.0 - 1e-12, -1.0}, 0.0));
}

TEST(Plan, RefusesBadWeights) {
  EXPECT_THROW((void)plan(diamond(), std::vector{-1.0}), std::invalid_argument);
  EXPECT_THROW((void)plan(diamond(), std::vector{-1.0, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_THROW((void)plan(diamond(), std::vector{-1.0, -1.0}, -1e-9), std::invalid_argument);
}

TEST(BestForRobot, PicksTheWayTheRobotLikesAmongTheLearnersBest) {
  const Mdp mdp = make_mdp(1, 1, {{0, 0, 1, {1, 0}}, {0, 1, 1, {0, 1}}, {0, 2, 1, {5, 0}}});
  const std::vector learner{-1.0, -1.0};
  const auto solution = plan(mdp, learner);
  ASSERT_TRUE(solution);
  EXPECT_EQ(best_for_robot(mdp, *solution, learner, {0, 3})[0], (IntegerVector{0, 1}));
  EXPECT_EQ(best_for_robot(mdp, *solution, learner, {9, 3})[0], (IntegerVector{1, 0}));
  EXPECT_EQ(best_for_robot(mdp, *solution, learner, {3, 3})[0], (IntegerVector{1, 0}));
}

TEST(BestForRobot, EqualsEnumerationOfAllOptimalTrajectories) {
  RandomStream random{15};
  int num_choices_open = 0;
  for (int i = 0; i < kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(6, random);
    const IntegerVector learner = random_weights(random);
    const IntegerVector robot = testing::random_vector(-9, 9, random);
    const auto solution = plan(mdp, testing::to_real(learner));
    if (!solution) continue;
    const auto found = best_for_robot(mdp, *solution, testing::to_real(learner), robot);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      auto paths = testing::all_paths(mdp, s);
      const auto by_learner = [&](const IntegerVector& mu) { return dot(learner, mu); };
      const Int128 best = by_learner(*std::ranges::max_element(paths, {}, by_learner));
      std::erase_if(paths, [&](const IntegerVector& mu) { return by_learner(mu) < best; });
      const auto by_robot = [&](const IntegerVector& mu) { return dot(robot, mu); };
      EXPECT_TRUE(by_robot(*std::ranges::max_element(paths, {}, by_robot)) == by_robot(found[s]));
      EXPECT_THAT(paths, ::testing::Contains(found[s]));
      num_choices_open += by_robot(*std::ranges::min_element(paths, {}, by_robot)) < by_robot(found[s]) ? 1 : 0;
    }
  }
  EXPECT_GT(num_choices_open, 50);
}

}  // namespace
}  // namespace kith
