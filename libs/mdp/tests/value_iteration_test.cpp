#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "kith/mdp/planner.hpp"
#include "small_mdps.hpp"

namespace kith {
namespace {

using testing::make_mdp;
using Transitions = std::vector<MdpBuilder::Transition>;

// A door that opens with probability p: state 0 tries it (action 0) or pays ten
// steps at once (action 1); a failure leads to state 1, which leads back.
Mdp sticky_door(double p, double discount) {
  MdpBuilder builder{2, 1, 2, 1, discount};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, Transitions{{StateIndex{2}, p, {1}}, {StateIndex{1}, 1 - p, {1}}});
  builder.add_choice(StateIndex{0}, ActionIndex{1}, Transitions{{StateIndex{2}, 1.0, {10}}});
  builder.add_choice(StateIndex{1}, ActionIndex{0}, Transitions{{StateIndex{0}, 1.0, {1}}});
  return std::move(builder).build();
}

// V(0) = -1 + g (1-p) V(1) and V(1) = -1 + g V(0).
double value_of_trying(double p, double g) { return -(1 + g * (1 - p)) / (1 - g * g * (1 - p)); }

TEST(ValueIteration, MatchesTheClosedFormOfAStickyDoor) {
  for (const double discount : {1.0, 0.9, 0.5}) {
    for (const double p : {0.9, 0.5, 0.05}) {
      const double expected = std::max(value_of_trying(p, discount), -10.0);
      const auto result = value_iteration(sticky_door(p, discount), std::vector{-1.0});
      ASSERT_TRUE(result.converged);
      EXPECT_NEAR(result.values[0], expected, 1e-9) << p << " " << discount;
      EXPECT_NEAR(result.values[1], -1 + discount * expected, 1e-9);
      EXPECT_EQ(result.greedy_choice[0], expected > -10.0 ? 0u : 1u);
    }
  }
}

TEST(ValueIteration, IsFiniteOnAGainingCycleIfDiscounted) {
  const Mdp swap = make_mdp(2, 0, {{0, 0, 1, {1}}, {1, 0, 0, {1}}}, 0.5);
  const auto result = value_iteration(swap, std::vector{1.0});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.values[0], 2.0, 1e-11);
  EXPECT_NEAR(result.values[1], 2.0, 1e-11);
}

TEST(ValueIteration, EqualsPlanWhereFiniteAndReportsPositiveCycles) {
  RandomStream random{21};
  int num_finite = 0;
  int num_positive = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const IntegerVector weights = testing::random_vector(-5, 1, random);
    const ExactPlan exact = plan_exactly(mdp, weights);
    const auto result = value_iteration(mdp, testing::to_real(weights));
    EXPECT_LE(result.sweeps, mdp.num_states() + 1);
    if (exact.failure == PlanFailure::kZeroCycle) continue;
    ASSERT_EQ(result.converged, exact.solution.has_value());
    num_positive += exact.failure == PlanFailure::kPositiveCycle ? 1 : 0;
    if (!exact.solution) continue;
    ++num_finite;
    EXPECT_EQ(result.values, std::vector<double>(exact.solution->values.begin(), exact.solution->values.end()));
    EXPECT_EQ(result.greedy_choice, exact.solution->canonical_choice);
  }
  EXPECT_GT(num_finite, 50);
  EXPECT_GT(num_positive, 20);
}

TEST(ValueIteration, DoesNotConvergeOnDeadEnds) {
  const Mdp certain = make_mdp(2, 1, {{0, 0, 2, {1}}});
  EXPECT_FALSE(value_iteration(certain, std::vector{-1.0}).converged);
  EXPECT_EQ(value_iteration(certain, std::vector{-1.0}).values[0], -1.0);
  EXPECT_EQ(value_iteration(certain, std::vector{-1.0}).values[1], -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(value_iteration(make_mdp(2, 1, {{0, 0, 2, {1}}}, 0.9), std::vector{-1.0}).converged);
}

TEST(ValueIteration, StopsAfterTheSweepsItMayTake) {
  const auto result = value_iteration(sticky_door(0.05, 1.0), std::vector{-0.01}, {.max_sweeps = 3});
  EXPECT_EQ(result.sweeps, 3u);
  EXPECT_FALSE(result.converged);
}

TEST(ValueIteration, RefusesBadArguments) {
  const Mdp mdp = sticky_door(0.5, 1.0);
  EXPECT_THROW((void)value_iteration(mdp, std::vector{1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)value_iteration(mdp, std::vector{std::numeric_limits<double>::infinity()}), std::invalid_argument);
  EXPECT_THROW((void)value_iteration(mdp, std::vector{-1.0}, {.tolerance = 0.0}), std::invalid_argument);
}

TEST(FeatureExpectations, MatchTheClosedFormOfAStickyDoor) {
  const std::vector<std::uint32_t> always_try{0, 0};
  for (const double discount : {1.0, 0.9}) {
    const auto mu = feature_expectations(sticky_door(0.25, discount), always_try);
    EXPECT_NEAR(mu[0], -value_of_trying(0.25, discount), 1e-9);
    EXPECT_NEAR(mu[1], 1 + discount * mu[0], 1e-9);
    EXPECT_EQ(mu[2], 0.0);
  }
}

TEST(FeatureExpectations, OfTheCanonicalPolicyAreItsFeatureCounts) {
  RandomStream random{22};
  int num_solved = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(7, random);
    const auto solution = plan_exactly(mdp, testing::random_vector(-5, 1, random)).solution;
    if (!solution) continue;
    ++num_solved;
    const auto mu = feature_expectations(mdp, solution->canonical_choice);
    ASSERT_EQ(mu.size(), solution->feature_counts.size() * 3);
    for (std::size_t s = 0; s < solution->feature_counts.size(); ++s) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(mu[3 * s + k], static_cast<double>(solution->feature_counts[s][k]));
      }
    }
  }
  EXPECT_GT(num_solved, 50);
}

// Four states, no terminal one, up to three actions with two outcomes each.
Mdp random_discounted_mdp(RandomStream& random) {
  constexpr std::size_t kStates = 4;
  MdpBuilder builder{kStates, 0, 3, 2, 0.8};
  for (std::size_t s = 0; s < kStates; ++s) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double p = 0.1 + 0.8 * uniform01(random);
      const StateIndex elsewhere{(s + 1 + uniform_index(kStates - 1, random)) % kStates};
      const StateIndex anywhere{uniform_index(kStates, random)};
      builder.add_choice(StateIndex{s}, ActionIndex{a},
                         Transitions{{elsewhere, p, {uniform01(random), uniform01(random)}},
                                     {anywhere, 1 - p, {uniform01(random), uniform01(random)}}});
    }
  }
  return std::move(builder).build();
}

TEST(ValueIteration, IsTheBestPolicysReturnInDiscountedChance) {
  RandomStream random{23};
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = random_discounted_mdp(random);
    const std::vector weights{2 * uniform01(random) - 1, 2 * uniform01(random) - 1};
    const auto result = value_iteration(mdp, weights);
    ASSERT_TRUE(result.converged);
    std::vector<double> best(mdp.num_states(), -std::numeric_limits<double>::infinity());
    testing::for_each_policy(mdp, [&](const std::vector<std::uint32_t>& policy) {
      const auto mu = feature_expectations(mdp, policy);
      for (std::size_t s = 0; s < best.size(); ++s) {
        best[s] = std::max(best[s], weights[0] * mu[2 * s] + weights[1] * mu[2 * s + 1]);
      }
    });
    // Both iterations stop within 1e-12 / (1 - 0.8) of their limits.
    for (std::size_t s = 0; s < best.size(); ++s) EXPECT_NEAR(result.values[s], best[s], 1e-10);
  }
}

TEST(FeatureExpectations, RefusePoliciesThatCannotFinish) {
  const Mdp loop = make_mdp(2, 1, {{0, 0, 1, {1}}, {1, 0, 0, {1}}, {1, 1, 2, {1}}});
  EXPECT_THROW((void)feature_expectations(loop, std::vector<std::uint32_t>{0, 0}), std::invalid_argument);
  EXPECT_NO_THROW((void)feature_expectations(loop, std::vector<std::uint32_t>{0, 1}));
  EXPECT_THROW((void)feature_expectations(loop, std::vector<std::uint32_t>{0, 2}), std::invalid_argument);
  EXPECT_THROW((void)feature_expectations(loop, std::vector<std::uint32_t>{0}), std::invalid_argument);
  EXPECT_THROW((void)feature_expectations(loop, std::vector<std::uint32_t>{0, 1}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
