#include "kith/mdp/policy_partition.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>

#include "small_mdps.hpp"

namespace kith {
namespace {

using testing::make_mdp;

std::vector<StateIndex> all_states(const Mdp& mdp) {
  std::vector<StateIndex> states;
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) states.push_back(s);
  return states;
}

std::vector<double> random_direction(RandomStream& random) {
  std::vector<double> weights(3);
  for (double& w : weights) w = standard_normal(random);
  if (uniform01(random) < 0.7) weights[2] = -std::abs(weights[2]) - 1.0;
  return weights;
}

// A floor of w x h cells with a few kinds of terrain, which is crossed twice: to the upper right and back. The first
// visit of the middle is counted once more, so that there are four components.
Mdp errand(std::size_t w, std::size_t h, RandomStream& random, double discount = 1.0) {
  std::vector<std::size_t> kind(w * h);
  for (auto& k : kind) k = uniform_index(4, random);
  const std::size_t n = w * h;
  const std::size_t middle = (h / 2) * w + w / 2;
  std::vector<testing::Edge> edges;
  for (std::size_t s = 0; s < 4 * n; ++s) {
    const std::size_t stage = s / n, x = s % n % w, y = s % n / w;
    const auto go = [&](std::size_t action, std::size_t to) {
      std::vector<double> phi{kind[s % n] == 1 ? 1.0 : 0.0, kind[s % n] == 2 ? 1.0 : 0.0, 1.0};
      std::size_t next = stage * n + to;
      if (stage < 2 && to == w - 1) next += 2 * n;
      if (stage % 2 == 0 && to == middle) {
        next += n;
        phi[0] += 1.0;
      }
      edges.push_back({s, action, stage >= 2 && to == n - w ? 4 * n : next, phi});
    };
    if (x + 1 < w) go(0, s % n + 1);
    if (x > 0) go(1, s % n - 1);
    if (y + 1 < h) go(2, s % n + w);
    if (y > 0) go(3, s % n - w);
  }
  return make_mdp(4 * n, 1, edges, discount);
}

void expect_same(PolicyPartition& partition, const Mdp& mdp, const std::vector<double>& weights,
                 const std::vector<double>& robot, std::int64_t scale = 1) {
  const auto behaviour = behave_in_favour(mdp, weights, robot, {.scale = scale});
  PolicyLookup lookup;
  ASSERT_EQ(lookup.locate(partition, weights), behaviour.has_value());
  if (!behaviour) return;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) ASSERT_EQ(lookup.counts(s), behaviour->counts[s]);
}

TEST(PolicyPartition, EqualsPlanningForAnyWeightsOfAnyProcess) {
  RandomStream random{31};
  for (int i = 0; i < testing::kNumRandom; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(9, random);
    const auto robot = testing::to_real(testing::random_vector(-9, 9, random));
    PolicyPartition partition{mdp, all_states(mdp), robot};
    for (int k = 0; k < 6; ++k) expect_same(partition, mdp, random_direction(random), robot);
    // Small integers: equally good ways with different counts.
    for (int k = 0; k < 6; ++k) expect_same(partition, mdp, testing::to_real(testing::random_weights(random)), robot);
  }
}

TEST(PolicyPartition, LooksUpWhatItHasMetInAProcessOfSeveralComponents) {
  RandomStream random{32};
  const Mdp mdp = errand(6, 5, random);
  const std::vector<double> robot{-2.0, 0.5, -1.0};
  PolicyPartition partition{mdp, all_states(mdp), robot};
  std::vector<std::vector<double>> weights;
  for (int k = 0; k < 300; ++k) weights.push_back(random_direction(random));
  for (const auto& w : weights) expect_same(partition, mdp, w, robot);
  const std::size_t num_parts = partition.num_parts();
  EXPECT_GT(num_parts, 20u);
  EXPECT_LT(num_parts, 300u);  // far fewer than weights times components
  for (const auto& w : weights) expect_same(partition, mdp, w, robot);
  EXPECT_EQ(partition.num_parts(), num_parts);
}

// The same process, discounted.
Mdp discounted(const Mdp& mdp, double discount) {
  std::vector<testing::Edge> edges;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      const auto phi = mdp.features(outcome);
      edges.push_back({s, choice.action.value(), outcome.next.value(), {phi.begin(), phi.end()}});
    }
  }
  return make_mdp(mdp.num_states(), mdp.num_terminals(), edges, discount);
}

TEST(PolicyPartition, EqualsPlanningInDiscountedProcesses) {
  constexpr std::int64_t kUnits = std::int64_t{1} << 24;
  RandomStream random{37};
  for (int i = 0; i < testing::kNumRandom / 3; ++i) {
    SCOPED_TRACE(i);
    const std::vector<double> discounts{0.3, 0.9, 0.95, 0.999};
    const Mdp mdp = discounted(testing::random_mdp(9, random), discounts[uniform_index(4, random)]);
    const auto robot = testing::to_real(testing::random_vector(-9, 9, random));
    PolicyPartition partition{mdp, all_states(mdp), robot, {.scale = kUnits}};
    for (int k = 0; k < 6; ++k) expect_same(partition, mdp, random_direction(random), robot, kUnits);
    for (int k = 0; k < 6; ++k) {
      expect_same(partition, mdp, testing::to_real(testing::random_weights(random)), robot, kUnits);
    }
  }
}

TEST(PolicyPartition, LooksUpWhatItHasMetInADiscountedProcess) {
  constexpr std::int64_t kUnits = std::int64_t{1} << 24;
  RandomStream random{38};
  for (const double discount : {0.9, 0.95, 0.99}) {
    const Mdp mdp = errand(6, 5, random, discount);
    const std::vector<double> robot{-2.0, 0.5, -1.0};
    PolicyPartition partition{mdp, all_states(mdp), robot, {.scale = kUnits}};
    std::vector<std::vector<double>> weights;
    for (int k = 0; k < 300; ++k) weights.push_back(random_direction(random));
    for (const auto& w : weights) expect_same(partition, mdp, w, robot, kUnits);
    const std::size_t num_parts = partition.num_parts();
    EXPECT_GT(num_parts, 20u);
    EXPECT_LT(num_parts, 600u);  // of 1 200 weights times components
    PolicyLookup lookup;
    std::size_t num_found = 0;
    for (const auto& w : weights) {
      ASSERT_TRUE(lookup.locate(partition, w));
      num_found += lookup.key().empty() ? 0u : 1u;
      expect_same(partition, mdp, w, robot, kUnits);
    }
    EXPECT_GT(num_found, 290u);
    EXPECT_EQ(partition.num_parts(), num_parts);
  }
}

TEST(PolicyPartition, HasEqualKeysForEqualBehaviourOnly) {
  RandomStream random{33};
  const Mdp mdp = errand(5, 4, random);
  PolicyPartition partition{mdp, all_states(mdp), {-2.0, 0.5, -1.0}};
  PolicyLookup lookup;
  std::vector<std::pair<std::vector<std::uint32_t>, std::vector<IntegerVector>>> met;
  int num_equal = 0;
  for (int k = 0; k < 200; ++k) {
    if (!lookup.locate(partition, random_direction(random))) continue;
    ASSERT_FALSE(lookup.key().empty());
    std::vector<IntegerVector> counts;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) counts.push_back(lookup.counts(s));
    const std::vector<std::uint32_t> key{lookup.key().begin(), lookup.key().end()};
    for (const auto& [known, its_counts] : met) {
      EXPECT_EQ(known == key, its_counts == counts);
      num_equal += known == key ? 1 : 0;
    }
    met.emplace_back(key, counts);
  }
  EXPECT_GT(num_equal, 100);
}

TEST(PolicyPartition, AnswersWithoutGrowing) {
  RandomStream random{34};
  const Mdp mdp = errand(5, 4, random);
  const std::vector<double> robot{-2.0, 0.5, -1.0};
  PolicyPartition partition{mdp, all_states(mdp), robot};
  const std::vector<double> weights{-1.0, -0.3, -1.0};
  const auto behaviour = behave_in_favour(mdp, weights, robot);
  PolicyLookup lookup;
  for (const bool may_grow : {false, true, false}) {
    const std::size_t before = partition.memory();
    ASSERT_TRUE(lookup.locate(partition, weights, may_grow));
    EXPECT_EQ(lookup.grown_by(), partition.memory() - before);
    EXPECT_EQ(partition.num_parts() > 0, partition.memory() > 0);
    EXPECT_EQ(lookup.key().empty(), partition.num_parts() == 0);
    EXPECT_EQ(lookup.grown_by() > 0, may_grow);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) EXPECT_EQ(lookup.counts(s), behaviour->counts[s]);
  }
}

// Two processes of different size and dimension, in turns.
TEST(PolicyLookup, GoesFromOnePartitionToAnother) {
  RandomStream random{35};
  const Mdp large = errand(5, 4, random);
  const Mdp small = testing::round_trip();
  const std::vector<double> robot_of_large{-2.0, 0.5, -1.0};
  const std::vector<double> robot_of_small{0.0, -1.0};
  PolicyPartition in_large{large, all_states(large), robot_of_large};
  PolicyPartition in_small{small, all_states(small), robot_of_small};
  PolicyLookup lookup;
  for (int k = 0; k < 20; ++k) {
    const std::vector<double> few{uniform01(random), -1.0};
    const auto many = random_direction(random);
    const auto of_small = behave_in_favour(small, few, robot_of_small);
    ASSERT_EQ(lookup.locate(in_small, few), of_small.has_value());
    for (std::size_t s = 0; of_small && s < small.num_states(); ++s) ASSERT_EQ(lookup.counts(s), of_small->counts[s]);
    const auto of_large = behave_in_favour(large, many, robot_of_large);
    ASSERT_EQ(lookup.locate(in_large, many), of_large.has_value());
    for (std::size_t s = 0; of_large && s < large.num_states(); ++s) ASSERT_EQ(lookup.counts(s), of_large->counts[s]);
  }
}

// Every thread asks for the same weights, each in an order of its own.
TEST(PolicyPartition, IsSharedByThreads) {
  constexpr std::size_t kThreads = 4;
  RandomStream random{36};
  const Mdp mdp = errand(6, 5, random);
  const std::vector<double> robot{-2.0, 0.5, -1.0};
  std::vector<std::vector<double>> weights;
  std::vector<std::optional<Behaviour>> expected;
  for (int k = 0; k < 120; ++k) {
    weights.push_back(random_direction(random));
    expected.push_back(behave_in_favour(mdp, weights.back(), robot));
  }
  PolicyPartition partition{mdp, all_states(mdp), robot};
  std::vector<std::size_t> num_wrong(kThreads, 0);
  std::vector<std::size_t> grown_by(kThreads, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      PolicyLookup lookup;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const std::size_t at = (i * (2 * t + 1) + 31 * t) % weights.size();
        const bool has_optimum = lookup.locate(partition, weights[at]);
        num_wrong[t] += has_optimum != expected[at].has_value() ? 1u : 0u;
        grown_by[t] += lookup.grown_by();
        for (std::size_t s = 0; has_optimum && expected[at] && s < mdp.num_states(); ++s) {
          num_wrong[t] += lookup.counts(s) != expected[at]->counts[s] ? 1u : 0u;
        }
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(num_wrong, std::vector<std::size_t>(kThreads, 0));
  EXPECT_EQ(std::accumulate(grown_by.begin(), grown_by.end(), std::size_t{0}), partition.memory());
  const std::size_t num_parts = partition.num_parts();
  for (const auto& w : weights) expect_same(partition, mdp, w, robot);
  EXPECT_EQ(partition.num_parts(), num_parts);
}

TEST(PolicyPartition, CountsInUnits) {
  const Mdp mdp = testing::round_trip();
  PolicyPartition partition{mdp, all_states(mdp), {0.0, -1.0}, {.scale = 16}};
  PolicyLookup lookup;
  ASSERT_TRUE(lookup.locate(partition, std::vector{1.0, -1.0}));
  EXPECT_EQ(lookup.counts(0), (IntegerVector{16, 32}));
  EXPECT_FALSE(lookup.locate(partition, std::vector{3.0, -1.0}));
}

TEST(PolicyPartition, RefusesWhatItCannotAnswer) {
  const Mdp mdp = testing::round_trip();
  PolicyPartition partition{mdp, all_states(mdp), {0.0, -1.0}};
  PolicyLookup lookup;
  EXPECT_THROW((void)lookup.locate(partition, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW((PolicyPartition{mdp, all_states(mdp), {1.0}}), std::invalid_argument);
  MdpBuilder builder{1, 1, 1, 2, 0.9};
  const std::vector<MdpBuilder::Transition> slips{{StateIndex{0}, 0.5, {1.0, 1.0}}, {StateIndex{1}, 0.5, {1.0, 1.0}}};
  builder.add_choice(StateIndex{0}, ActionIndex{0}, slips);
  const Mdp stochastic = std::move(builder).build();
  EXPECT_FALSE(can_be_partitioned(stochastic));
  EXPECT_THROW((PolicyPartition{stochastic, all_states(stochastic), {1.0, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
