#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "small_mdps.hpp"
#include "value_iteration.hpp"

namespace kith {
namespace {

using testing::make_mdp;
using testing::value_iteration;
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
      EXPECT_NEAR(behave(sticky_door(p, discount), std::vector{-1.0})->values[0], expected, 1e-9);
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

}  // namespace
}  // namespace kith
