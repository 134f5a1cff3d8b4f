// systematic_counts of particle_belief.hpp, and the indices made from it.

#include "../src/systematic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/distributions.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::total;

TEST(SystematicCounts, AreWithinOneOfTheExpectation) {
  RandomStream random{1};
  for (int round = 0; round < 300; ++round) {
    const std::size_t size = 1 + uniform_index(60, random);
    const std::size_t n = uniform_index(200, random);
    std::vector<double> weights;
    for (std::size_t i = 0; i < size; ++i) {
      const double w = std::exp(-20.0 * uniform01(random));
      weights.push_back(uniform01(random) < 0.3 && i + 1 < size ? 0.0 : w);
    }
    const double sum = total(weights);
    const auto counts = systematic_counts(weights, n, uniform01(random));
    ASSERT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), n);
    for (std::size_t i = 0; i < size; ++i) {
      const double expected = static_cast<double>(n) * weights[i] / sum;
      ASSERT_LT(std::abs(static_cast<double>(counts[i]) - expected), 1.0 + 1e-9);
      if (weights[i] == 0.0) {
        ASSERT_EQ(counts[i], 0u);
      }
    }
  }
}

TEST(SystematicCounts, MatchAHandComputedTable) {
  const std::vector<double> weights{0.5, 0.25, 0.0, 0.25};
  EXPECT_EQ(systematic_counts(weights, 4, 0.5), (std::vector<std::size_t>{2, 1, 0, 1}));
  EXPECT_EQ(systematic_counts(weights, 3, 0.0), (std::vector<std::size_t>{2, 1, 0, 0}));   // 0, 1/3, 2/3
  EXPECT_EQ(systematic_counts(weights, 3, 0.75), (std::vector<std::size_t>{1, 1, 0, 1}));  // 1/4, 7/12, 11/12
  EXPECT_EQ(systematic_counts(weights, 0, 0.5), (std::vector<std::size_t>{0, 0, 0, 0}));
}

TEST(SystematicCounts, NeverDrawWhatHasNoWeightWhateverRoundingSays) {
  std::vector<double> weights(1000, 0.1);
  weights.push_back(0.0);
  for (const double u : {0.0, 0x1.0p-53, 0.5, 1.0 - 0x1.0p-53}) {
    const auto counts = systematic_counts(weights, 1000, u);
    EXPECT_EQ(counts.back(), 0u);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), 1000u);
  }
}

// Over a uniform offset the expected count is n p_i. 4 000 offsets on a regular grid integrate it to 1/4000.
TEST(SystematicCounts, AreUnbiasedOverTheOffset) {
  const std::vector<double> weights{0.37, 0.01, 0.3, 0.02, 0.3};
  std::vector<double> mean(weights.size(), 0.0);
  for (int k = 0; k < 4000; ++k) {
    const auto counts = systematic_counts(weights, 7, (k + 0.5) / 4000.0);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += static_cast<double>(counts[i]) / 4000.0;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(mean[i], 7.0 * weights[i], 1.0 / 2000.0);
}

TEST(SystematicIndices, RepeatEachIndexAsOftenAsItsCountSays) {
  RandomStream random{2};
  for (int round = 0; round < 200; ++round) {
    std::vector<double> weights(1 + uniform_index(60, random));
    for (double& w : weights) w = std::exp(-12.0 * uniform01(random));
    const std::size_t n = 1 + uniform_index(300, random);
    const double u = uniform01(random);
    std::vector<std::uint32_t> index(n + detail::kIndexRoom);
    detail::systematic_indices(weights, u, index);
    std::vector<std::uint32_t> expected;
    const auto counts = systematic_counts(weights, n, u);
    for (std::uint32_t i = 0; i < counts.size(); ++i) expected.insert(expected.end(), counts[i], i);
    index.resize(n);
    ASSERT_EQ(index, expected);
  }
}

TEST(SystematicCounts, RefuseWhatIsNoDistribution) {
  EXPECT_THROW((void)systematic_counts(std::vector{0.0, 0.0}, 3, 0.5), std::invalid_argument);
  EXPECT_THROW((void)systematic_counts(std::vector{1.0, -0.5}, 3, 0.5), std::invalid_argument);
  EXPECT_THROW((void)systematic_counts(std::vector{1.0, std::nan("")}, 3, 0.5), std::invalid_argument);
  EXPECT_THROW((void)systematic_counts(std::vector<double>{}, 3, 0.5), std::invalid_argument);
  EXPECT_THROW((void)systematic_counts(std::vector{1.0}, 3, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace kith
