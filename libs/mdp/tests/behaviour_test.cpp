#include "kith/mdp/behaviour.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "kith/core/error.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/mdp/coverage_set.hpp"
#include "kith/mdp/planner.hpp"
#include "linear_program.hpp"
#include "policy_oracle.hpp"

namespace kith {
namespace {

using testing::Case;
using ::testing::ElementsAre;
using testing::Kind;
using testing::make_mdp;
using testing::PolicyOracle;

constexpr std::int64_t kScale = std::int64_t{1} << 20;
constexpr double kGainTolerance = 1e-9;

bool is_optimal_within(double value, double candidate) {
  return candidate >= value - 1e-9 * std::max(1.0, std::abs(value));
}

double worth(const Mdp& mdp, const Choice& choice, std::span<const double> weights, std::span<const double> values) {
  double sum = 0.0;
  for (const Outcome& outcome : mdp.outcomes(choice)) {
    double reward = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) reward += weights[k] * mdp.features(outcome)[k];
    sum += outcome.probability * (reward + mdp.discount() * values[outcome.next.value()]);
  }
  return sum;
}

std::vector<std::vector<bool>> optimal_choices(const Mdp& mdp, std::span<const double> weights,
                                               std::span<const double> values) {
  std::vector<std::vector<bool>> optimal(mdp.num_states());
  for (std::size_t s = 0; s < optimal.size(); ++s) {
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      optimal[s].push_back(is_optimal_within(values[s], worth(mdp, choice, weights, values)));
    }
  }
  return optimal;
}

// The rule of Behaviour::choice: the first optimal one, but where that never ends, if it can be helped.
void expect_canonical(const Mdp& mdp, const std::vector<std::vector<bool>>& optimal,
                      const std::vector<std::uint32_t>& choice, const PolicyOracle& oracle) {
  PolicyOracle::Policy first(mdp.num_states(), 0);
  for (std::size_t s = 0; s < first.size(); ++s) {
    ASSERT_TRUE(optimal[s][choice[s]]) << "state " << s;
    while (!optimal[s][first[s]]) ++first[s];
  }
  const auto ends_anyway = oracle.can_finish(first);
  const auto ends = oracle.can_finish(choice);
  for (std::size_t s = 0; s < first.size(); ++s) {
    if (ends_anyway[s] || !ends[s]) {
      EXPECT_EQ(choice[s], first[s]) << "state " << s;
    }
    if (mdp.discount() == 1.0) {
      EXPECT_TRUE(ends[s]) << "state " << s;
    }
  }
}

void expect_counts(const PolicyOracle& oracle, const Behaviour& behaviour) {
  const Eigen::MatrixXd mu = oracle.features(behaviour.choice);
  for (Eigen::Index s = 0; s < mu.rows(); ++s) {
    for (Eigen::Index k = 0; k < mu.cols(); ++k) {
      const auto units = behaviour.counts[static_cast<std::size_t>(s)][static_cast<std::size_t>(k)];
      EXPECT_NEAR(static_cast<double>(units), mu(s, k) * static_cast<double>(kScale), 0.501) << "state " << s;
    }
  }
}

// mu(s, b), rounded: the choice once, then the policy.
IntegerVector deviation(const Mdp& mdp, const Choice& choice, std::span<const IntegerVector> counts) {
  IntegerVector rounded(mdp.num_features());
  for (std::size_t k = 0; k < rounded.size(); ++k) {
    double units = 0.0;
    for (const Outcome& outcome : mdp.outcomes(choice)) {
      const double rest = mdp.discount() * static_cast<double>(counts[outcome.next.value()][k]);
      units += outcome.probability * (static_cast<double>(kScale) * mdp.features(outcome)[k] + rest);
    }
    rounded[k] = std::llround(units);
  }
  return rounded;
}

// What the deviations say about the weights, without what follows from the rest, is what linear programs leave of it.
void expect_minimal_as_by_linear_programs(const Mdp& mdp, const Behaviour& behaviour) {
  // Extreme rays are made of minors of d - 1 normals and must fit into 64 bits: expectations in units of 2^-20 often do
  // not, counts do.
  const auto largest = static_cast<std::int64_t>(std::exp2(54.0 / static_cast<double>(mdp.num_features() - 1)) / 4.0);
  std::set<IntegerVector> normals;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      const IntegerVector normal = primitive(behaviour.counts[s] - deviation(mdp, choice, behaviour.counts));
      const bool is_small = std::ranges::all_of(
          normal, [&](std::int64_t x) { return std::abs(x) < std::min(largest, std::int64_t{1} << 31); });
      if (!normal.is_zero() && is_small) normals.insert(normal);
    }
  }
  if (normals.empty()) return;
  const std::vector<HalfSpace> system(normals.begin(), normals.end());
  const auto minimal = minimal_set(system);
  const std::vector<IntegerVector> all(normals.begin(), normals.end());
  ASSERT_EQ(minimal.has_value(), testing::lp_has_interior(all));
  if (!minimal) return;
  std::vector<IntegerVector> left;
  for (const HalfSpace& half_space : *minimal) left.push_back(half_space.normal());
  EXPECT_EQ(left, testing::lp_minimal_set(all));
}

// The best feature counts of the coverage set are worth what the best policy is.
void expect_covered(const Case& example, const PolicyOracle& oracle) {
  try {
    const CoverageSets sets = coverage_sets(example.mdp);
    for (std::size_t s = 0; s < example.mdp.num_states(); ++s) {
      double best = -std::numeric_limits<double>::infinity();
      for (const IntegerVector& mu : sets.vertices(StateIndex{s})) best = std::max(best, dot(mu, example.weights));
      EXPECT_NEAR(best, oracle.best[s], 1e-9) << "state " << s;
    }
  } catch (const Error& error) {  // for other weights some cycle costs nothing at all
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
  }
}

// No single deviation is better: (mu(s) - mu(s, b)) . w >= 0 up to the rounding of the counts.
void expect_one_step_constraints(const Case& example, const Behaviour& behaviour) {
  const Mdp& mdp = example.mdp;
  double rounding = 0.0;
  for (const double w : example.weights) rounding += std::abs(w);
  rounding *= 1.01 / static_cast<double>(kScale);
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      double slack = dot(behaviour.counts[s], example.weights) / static_cast<double>(kScale);
      for (const Outcome& outcome : mdp.outcomes(choice)) {
        double reward = 0.0;
        for (std::size_t k = 0; k < example.weights.size(); ++k)
          reward += example.weights[k] * mdp.features(outcome)[k];
        const double rest = dot(behaviour.counts[outcome.next.value()], example.weights) / static_cast<double>(kScale);
        slack -= outcome.probability * (reward + mdp.discount() * rest);
      }
      EXPECT_GE(slack, -rounding - 1e-7) << "state " << s;
    }
  }
}

void expect_the_best_for_the_robot(const Case& example, const Behaviour& behaviour) {
  const Mdp& mdp = example.mdp;
  const auto robot = testing::to_real(example.robot_weights);
  PolicyOracle oracle{mdp, robot};
  oracle.restrict(optimal_choices(mdp, example.weights, behaviour.values));
  oracle.enumerate();
  const auto favour = behave_in_favour(mdp, example.weights, robot, {.scale = kScale});
  if (oracle.highest_gain > kGainTolerance) {
    EXPECT_FALSE(favour);
    return;
  }
  ASSERT_TRUE(favour);
  EXPECT_EQ(favour->values, behaviour.values);
  const Eigen::VectorXd values = oracle.values(favour->choice);
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    EXPECT_NEAR(values(static_cast<Eigen::Index>(s)), oracle.best[s], 1e-6) << "state " << s;
  }
  expect_counts(oracle, *favour);
}

// Where a count is a whole number it is that number, whatever the unit; and what plan_exactly() finds, where the
// weights are whole numbers, too.
void expect_exact(const Case& example, const std::optional<Behaviour>& behaviour) {
  const Mdp& mdp = example.mdp;
  const auto exact = behave(mdp, example.weights);
  ASSERT_EQ(exact.has_value(), behaviour.has_value());
  const auto expect_same = [&](const Behaviour& one, const Behaviour& in_units) {
    EXPECT_EQ(one.choice, in_units.choice);
    EXPECT_EQ(one.values, in_units.values);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      EXPECT_EQ(one.counts[s], testing::roll_out(mdp, one.choice, s).features) << "state " << s;
      for (std::size_t k = 0; k < mdp.num_features(); ++k) {
        EXPECT_EQ(kScale * one.counts[s][k], in_units.counts[s][k]) << "state " << s;
      }
    }
  };
  if (exact) {
    const auto robot = testing::to_real(example.robot_weights);
    expect_same(*exact, *behaviour);
    expect_same(behave_in_favour(mdp, example.weights, robot).value(),
                behave_in_favour(mdp, example.weights, robot, {.scale = kScale}).value());
  }
  if (std::ranges::any_of(example.weights, [](double w) { return w != std::round(w); })) return;
  IntegerVector weights(mdp.num_features());
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = std::llround(example.weights[k]);
  const auto solution = plan_exactly(mdp, weights).solution;
  ASSERT_EQ(exact.has_value(), solution.has_value());
  if (!solution) return;
  EXPECT_EQ(exact->choice, solution->canonical_choice);
  EXPECT_EQ(exact->counts, solution->feature_counts);
}

void expect_agrees_with_enumeration(const Case& example) {
  const Mdp& mdp = example.mdp;
  const auto behaviour = behave(mdp, example.weights, {.scale = kScale});
  if (is_exact(mdp)) expect_exact(example, behaviour);
  PolicyOracle oracle{mdp, example.weights};
  oracle.enumerate();
  const bool has_gain = oracle.highest_gain > kGainTolerance;
  const bool rests = is_exact(mdp) && oracle.highest_gain > -kGainTolerance;  // never finishing is as good
  ASSERT_EQ(behaviour.has_value(), !(oracle.has_dead_end || oracle.is_stranded || has_gain || rests));
  if (!behaviour) return;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) EXPECT_NEAR(behaviour->values[s], oracle.best[s], 1e-7);
  const auto optimal = optimal_choices(mdp, example.weights, behaviour->values);
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    for (std::size_t c = 0; c < optimal[s].size(); ++c) {
      EXPECT_EQ(is_optimal(mdp, *behaviour, example.weights, StateIndex{s}, c), optimal[s][c]) << "state " << s;
    }
  }
  expect_canonical(mdp, optimal, behaviour->choice, oracle);
  expect_counts(oracle, *behaviour);
  expect_one_step_constraints(example, *behaviour);
  expect_minimal_as_by_linear_programs(mdp, *behaviour);
  expect_the_best_for_the_robot(example, *behaviour);
  if (is_exact(mdp) && mdp.num_features() == 3) expect_covered(example, oracle);
}

void expect_all_agree_with_enumeration(std::uint64_t num_cases) {
  std::size_t num_solved = 0;
  for (std::uint64_t i = 0; i < num_cases && !::testing::Test::HasFailure(); ++i) {
    RandomStream random = RandomStream{2024}.split(i);
    const Kind kind = static_cast<Kind>(i % 3);
    const std::size_t d = 2 + i / 3 % 7;
    const Case example = testing::random_case(kind, d, random);
    SCOPED_TRACE("case " + std::to_string(i));
    expect_agrees_with_enumeration(example);
    num_solved += behave(example.mdp, example.weights).has_value() ? 1u : 0u;
  }
  EXPECT_GT(num_solved, num_cases / 4);  // the others have no finite optimum
}

TEST(Behave, AgreesWithEnumeratingAllPolicies) { expect_all_agree_with_enumeration(600); }
TEST(BehaveSlow, AgreesWithEnumeratingAllPoliciesTenThousandTimes) { expect_all_agree_with_enumeration(10'000); }

// State 0 tries until it succeeds; one try in four does.
Mdp tries(double discount) {
  MdpBuilder builder{1, 1, 1, 2, discount};
  const std::vector<MdpBuilder::Transition> coin{{StateIndex{0}, 0.75, {1, 0}}, {StateIndex{1}, 0.25, {1, 1}}};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, coin);
  return std::move(builder).build();
}

TEST(Behave, CountsExpectedTries) {
  const auto once = behave(tries(1.0), std::vector{-1.0, 10.0}, {.scale = 1024});
  ASSERT_TRUE(once);
  EXPECT_NEAR(once->values[0], 6.0, 1e-12);
  EXPECT_THAT(once->counts, ElementsAre(IntegerVector{4096, 1024}, IntegerVector{0, 0}));
  const auto soon = behave(tries(0.8), std::vector{-1.0, 10.0}, {.scale = 1000});
  EXPECT_EQ(soon->counts[0], (IntegerVector{2500, 625}));  // 1 / (1 - 0.6), 0.25 of that
}

TEST(Behave, SaysWhenEndingIsTooRareToBeCounted) {
  MdpBuilder builder{1, 1, 1, 1, 1.0};
  const std::vector<MdpBuilder::Transition> hardly_ever{{StateIndex{0}, 1.0 - 1e-12, {1}}, {StateIndex{1}, 1e-12, {1}}};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, hardly_ever);
  try {
    (void)behave(std::move(builder).build(), std::vector{-1.0}, {.scale = kScale});
    FAIL() << "2^60 units were counted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
  }
}

// A corridor in which going back and forth at the far end earns most. Where the discount is near 1 a few sweeps over
// the values of one policy say little about the next.
TEST(Behave, ComesToAnEndWithADiscountNearOne) {
  constexpr std::size_t kLast = 11;
  for (const double discount : {0.99, 0.9999, 0.999999}) {
    MdpBuilder builder{kLast + 1, 1, 2, 2, discount};
    for (std::size_t s = 0; s <= kLast; ++s) {
      using Transitions = std::vector<MdpBuilder::Transition>;
      const StateIndex left{s == 0 ? kLast + 1 : s - 1};
      const StateIndex right{s == kLast ? kLast - 1 : s + 1};
      builder.add_choice(StateIndex{s}, ActionIndex{0}, Transitions{{left, 1.0, {0.5, 0.0}}});
      builder.add_choice(StateIndex{s}, ActionIndex{1}, Transitions{{right, 1.0, {0.0, s == kLast ? 1.2 : 0.0}}});
    }
    const auto behaviour = behave(std::move(builder).build(), std::vector{1.0, 1.0}, {.scale = 1 << 20});
    ASSERT_TRUE(behaviour) << discount;
    EXPECT_NEAR(behaviour->values[kLast] * (1.0 - discount * discount), 1.2, 1e-9) << discount;
    for (const auto choice : behaviour->choice) EXPECT_EQ(choice, 1u) << discount;
  }
}

// From 0 to the end at once, or round through 1, which leads back for certain.
Mdp with_a_way_round(double there, double back, double out) {
  return make_mdp(2, 1, {{0, 0, 1, {there}}, {0, 1, 2, {out}}, {1, 0, 0, {back}}});
}

TEST(Behave, FinishesWhereGoingRoundCostsNothing) {
  const auto behaviour = behave(with_a_way_round(0.5, -0.5, -0.25), std::vector{1.0}, {.scale = 4});
  ASSERT_TRUE(behaviour);
  EXPECT_THAT(behaviour->choice, ElementsAre(1u, 0u));
  EXPECT_THAT(behaviour->counts, ElementsAre(IntegerVector{-1}, IntegerVector{-3}, IntegerVector{0}));
  // Of exact processes it says, as plan_exactly() does, that never finishing is as good.
  EXPECT_FALSE(behave(with_a_way_round(1, -1, -1), std::vector{1.0}));
}

TEST(Behave, FindsNothingWhereGoingRoundGains) {
  EXPECT_FALSE(behave(with_a_way_round(0.5, -0.25, -0.25), std::vector{1.0}));
  EXPECT_FALSE(behave(with_a_way_round(2, -1, -1), std::vector{1.0}));
}

TEST(Behave, GoesRoundForEverOnlyIfDiscounted) {
  const Mdp mdp = make_mdp(2, 1, {{0, 0, 1, {1}}, {0, 1, 2, {0}}, {1, 0, 0, {0}}}, 0.5);
  const auto behaviour = behave(mdp, std::vector{3.0}, {.scale = 3});
  ASSERT_TRUE(behaviour);
  EXPECT_THAT(behaviour->choice, ElementsAre(0u, 0u));
  EXPECT_EQ(behaviour->counts[0], IntegerVector{4});                        // 1 / (1 - 0.25)
  EXPECT_THAT(behave(mdp, std::vector{0.0})->choice, ElementsAre(1u, 0u));  // all is equal: it finishes
}

TEST(Behave, NeedsAWayOnFromEverywhere) {
  const Mdp dead_end = make_mdp(2, 1, {{0, 0, 1, {1}}, {0, 1, 2, {1}}}, 0.9);
  EXPECT_FALSE(behave(dead_end, std::vector{-1.0}));
  const Mdp trap = make_mdp(3, 1, {{0, 0, 1, {1}}, {0, 1, 3, {1}}, {1, 0, 2, {1}}, {2, 0, 1, {1}}});
  EXPECT_FALSE(behave(trap, std::vector{-1.0}));
}

TEST(Behave, SolvesAChainThatHardlyEverEnds) {
  // One step forward in a thousand, else back to the start: sweeps alone would not come to rest.
  MdpBuilder builder{2, 1, 1, 1, 1.0};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, std::vector<MdpBuilder::Transition>{{StateIndex{1}, 1.0, {1}}});
  builder.add_choice(StateIndex{1}, ActionIndex{0},
                     std::vector<MdpBuilder::Transition>{{StateIndex{0}, 0.999, {1}}, {StateIndex{2}, 0.001, {1}}});
  const auto behaviour = behave(std::move(builder).build(), std::vector{-1.0}, {.scale = 1000});
  ASSERT_TRUE(behaviour);
  EXPECT_THAT(behaviour->counts, ElementsAre(IntegerVector{2'000'000}, IntegerVector{1'999'000}, IntegerVector{0}));
}

// What comes first leads to the end only by a chance of 1e-40, from where nothing can be computed.
TEST(Behave, StartsFromWhatEndsWithAFairChance) {
  const auto ladder = [](bool with_stairs) {
    constexpr std::size_t kRungs = 8;
    MdpBuilder builder{kRungs, 1, 2, 1, 1.0};
    for (std::size_t s = 0; s < kRungs; ++s) {
      const StateIndex up{s + 1}, foot{0}, again{s == 0 ? 1u : 0u};
      builder.add_choice(
          StateIndex{s}, ActionIndex{0},
          std::vector<MdpBuilder::Transition>{{up, 1e-5, {1}}, {s == 0 ? again : foot, 1.0 - 1e-5, {1}}});
      if (with_stairs) {
        builder.add_choice(StateIndex{s}, ActionIndex{1},
                           std::vector<MdpBuilder::Transition>{{up, 0.5, {10}}, {StateIndex{s}, 0.5, {10}}});
      }
    }
    return std::move(builder).build();
  };
  const auto behaviour = behave(ladder(true), std::vector{-1.0});
  ASSERT_TRUE(behaviour);
  EXPECT_NEAR(behaviour->values[1], -20.0 * 7, 1e-9);
  EXPECT_THROW((void)behave(ladder(false), std::vector{-1.0}), Error);
}

TEST(Behave, RefusesNonsense) {
  const Mdp mdp = make_mdp(1, 1, {{0, 0, 1, {1, 1}}});
  EXPECT_THROW((void)behave(mdp, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW((void)behave(mdp, std::vector{1.0, std::nan("")}), std::invalid_argument);
  EXPECT_THROW((void)behave(mdp, std::vector{1.0, 1.0}, {.scale = 0}), std::invalid_argument);
  EXPECT_THROW((void)behave(mdp, std::vector{1.0, 1.0}, {.tolerance = -1.0}), std::invalid_argument);
  EXPECT_THROW((void)behave_in_favour(mdp, std::vector{1.0, 1.0}, std::vector{1.0}), std::invalid_argument);
  const auto behaviour = behave(mdp, std::vector{1.0, 1.0}).value();
  EXPECT_TRUE(is_optimal(mdp, behaviour, std::vector{1.0, 1.0}, StateIndex{0}, 0));
  EXPECT_THROW((void)is_optimal(mdp, behaviour, std::vector{1.0}, StateIndex{0}, 0), std::invalid_argument);
  EXPECT_THROW((void)is_optimal(mdp, behaviour, std::vector{1.0, 1.0}, StateIndex{0}, 1), std::invalid_argument);
  EXPECT_THROW((void)is_optimal(mdp, behaviour, std::vector{1.0, 1.0}, StateIndex{1}, 0), std::invalid_argument);
  EXPECT_THROW((void)is_optimal(mdp, {}, std::vector{1.0, 1.0}, StateIndex{0}, 0), std::invalid_argument);
  const Mdp huge = make_mdp(1, 1, {{0, 0, 1, {1e12}}});
  EXPECT_THROW((void)behave(huge, std::vector{1.0}, {.scale = kScale}), Error);
}

TEST(Mdp, ListsComponentsAfterThoseTheyLeadTo) {
  // 0 -> 1 <-> 2 -> 3 -> end.
  const Mdp mdp = make_mdp(4, 1, {{0, 0, 1, {1}}, {1, 0, 2, {1}}, {2, 0, 1, {1}}, {2, 1, 3, {1}}, {3, 0, 4, {1}}});
  EXPECT_THAT(mdp.by_component(), ElementsAre(StateIndex{3}, StateIndex{1}, StateIndex{2}, StateIndex{0}));
  EXPECT_THAT(mdp.component_starts(), ElementsAre(0u, 1u, 3u, 4u));
}

}  // namespace
}  // namespace kith
