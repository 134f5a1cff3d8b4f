#include "kith/mdp/planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "path_features.hpp"
#include "small_mdps.hpp"

namespace kith {
namespace {

using testing::diamond;
using ::testing::ElementsAre;
using testing::kNumRandom;
using testing::make_mdp;
using testing::round_trip;

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
    const IntegerVector weights = testing::random_weights(random);
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
    const IntegerVector weights = testing::random_weights(random);
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

// 0 -> 1 <-> 2: one step in, and round.
Trajectory round_of_two() {
  return {{StateIndex{0}, StateIndex{1}, StateIndex{2}, StateIndex{1}},
          {ActionIndex{0}, ActionIndex{1}, ActionIndex{2}},
          1};
}

TEST(Trajectory, GoesRoundForEverWhereItRepeats) {
  const auto path = round_of_two();
  std::vector<std::size_t> actions;
  for (std::size_t t = 0; t < 7; ++t) actions.push_back(path.action(t).value());
  EXPECT_THAT(actions, ElementsAre(0, 1, 2, 1, 2, 1, 2));
  for (std::size_t steps = 0; steps < 9; ++steps) {
    const auto longer = written_out(path, steps);
    ASSERT_EQ(longer.actions.size(), std::max<std::size_t>(steps, 3));
    EXPECT_EQ(longer.states[*longer.repeats_from], longer.states.back());
    EXPECT_EQ(longer.actions.size() - *longer.repeats_from, 2U);
    EXPECT_FALSE(first_difference(path, longer));
  }
  EXPECT_EQ(written_out({{StateIndex{0}}, {}}, 5).actions.size(), 0U);
}

TEST(Trajectory, DiffersWhereActionsDoOrOneHasEnded) {
  const auto path = round_of_two();
  auto other = written_out(path, 6);
  other.actions.back() = ActionIndex{3};
  EXPECT_EQ(first_difference(path, other), 5U);
  const Trajectory ends{{StateIndex{0}, StateIndex{1}}, {ActionIndex{0}}};
  EXPECT_EQ(first_difference(path, ends), 1U);
  EXPECT_EQ(first_difference(ends, path), 1U);
  EXPECT_FALSE(first_difference(ends, ends));
}

TEST(PathFeatures, SumUpTheCycleAsASeries) {
  const Mdp mdp = make_mdp(3, 1, {{0, 0, 1, {1, 0}}, {1, 1, 2, {0, 1}}, {2, 2, 1, {2, 3}}, {2, 3, 3, {0, 0}}}, 0.5);
  const auto once = testing::path_features(mdp, round_of_two());
  // 1 + ..., with the cycle (0, 1) + (2, 3) / 2 begun at half its worth and a quarter each time.
  EXPECT_THAT(once, ElementsAre(::testing::DoubleNear(1.0 + 0.5 * 1.0 / 0.75, 1e-15),
                                ::testing::DoubleNear(0.5 * 2.5 / 0.75, 1e-15)));
  for (std::size_t steps = 4; steps < 60; ++steps) {
    const auto again = testing::path_features(mdp, written_out(round_of_two(), steps));
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(again[k], once[k], 1e-14);
  }
  const Trajectory ends{{StateIndex{2}, StateIndex{3}}, {ActionIndex{3}}};
  EXPECT_THAT(testing::path_features(mdp, ends), ElementsAre(0.0, 0.0));
}

}  // namespace
}  // namespace kith
