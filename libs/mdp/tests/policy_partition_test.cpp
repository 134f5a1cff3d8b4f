#include "kith/mdp/policy_partition.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

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
Mdp errand(std::size_t w, std::size_t h, RandomStream& random) {
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
  return make_mdp(4 * n, 1, edges);
}

void expect_same(PolicyPartition& partition, const Mdp& mdp, const std::vector<double>& weights,
                 const std::vector<double>& robot) {
  const auto behaviour = behave_in_favour(mdp, weights, robot);
  ASSERT_EQ(partition.locate(weights), behaviour.has_value());
  if (!behaviour) return;
  for (std::size_t s = 0; s < mdp.num_states(); ++s) ASSERT_EQ(partition.counts(s), behaviour->counts[s]);
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

TEST(PolicyPartition, HasEqualKeysForEqualBehaviourOnly) {
  RandomStream random{33};
  const Mdp mdp = errand(5, 4, random);
  PolicyPartition partition{mdp, all_states(mdp), {-2.0, 0.5, -1.0}};
  std::vector<std::pair<std::vector<std::uint32_t>, std::vector<IntegerVector>>> met;
  int num_equal = 0;
  for (int k = 0; k < 200; ++k) {
    if (!partition.locate(random_direction(random))) continue;
    ASSERT_FALSE(partition.key().empty());
    std::vector<IntegerVector> counts;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) counts.push_back(partition.counts(s));
    const std::vector<std::uint32_t> key{partition.key().begin(), partition.key().end()};
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
  for (const bool may_grow : {false, true, false}) {
    ASSERT_TRUE(partition.locate(weights, may_grow));
    for (std::size_t s = 0; s < mdp.num_states(); ++s) EXPECT_EQ(partition.counts(s), behaviour->counts[s]);
  }
  EXPECT_GT(partition.num_parts(), 0u);
  EXPECT_GT(partition.memory(), 0u);
  partition.clear();
  EXPECT_EQ(partition.num_parts(), 0u);
  EXPECT_EQ(partition.memory(), 0u);
  ASSERT_TRUE(partition.locate(weights, false));
  EXPECT_EQ(partition.num_parts(), 0u);
  EXPECT_TRUE(partition.key().empty());
}

TEST(PolicyPartition, CountsInUnits) {
  const Mdp mdp = testing::round_trip();
  PolicyPartition partition{mdp, all_states(mdp), {0.0, -1.0}, {.scale = 16}};
  ASSERT_TRUE(partition.locate(std::vector{1.0, -1.0}));
  EXPECT_EQ(partition.counts(0), (IntegerVector{16, 32}));
  EXPECT_FALSE(partition.locate(std::vector{3.0, -1.0}));
}

TEST(PolicyPartition, RefusesWhatItCannotAnswer) {
  const Mdp mdp = testing::round_trip();
  PolicyPartition partition{mdp, all_states(mdp), {0.0, -1.0}};
  EXPECT_THROW((void)partition.locate(std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW((PolicyPartition{mdp, all_states(mdp), {1.0}}), std::invalid_argument);
  const Mdp discounted = make_mdp(1, 1, {{0, 0, 1, {1, 1}}}, 0.9);
  EXPECT_THROW((PolicyPartition{discounted, all_states(discounted), {1.0, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
