#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "kith/analysis/clustered_tests.hpp"

namespace kith {
namespace {

// Five blocks of the levels a, b, c, with ties within blocks, and one block without spread.
const std::vector<double> kBlocked{5.1, 4.9, 5.3, 6.2, 6.2, 5.8, 4.4, 5.0, 4.7, 5.5, 5.9, 6.1, 4.9, 4.9, 4.9};
const Factor kWithin{"within", {"a", "b", "c"}, {0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2}};
const Factor kBlock{"block", {"1", "2", "3", "4", "5"}, {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}};

// Six clusters, each with two values of the first sample and one of the second.
const std::vector<double> kClustered{1.0, 2.5, 0.3, 4.1, 3.2, 1.9, 2.2, 0.4, 5.0,
                                     3.3, 3.9, 2.0, 0.7, 1.5, 6.1, 2.8, 2.9, 0.2};
const Factor kSample{"sample", {"x", "y"}, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}};
const Factor kCluster{
    "cluster", {"1", "2", "3", "4", "5", "6"}, {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5}};

// R 4.2: friedman.test(x, within, block).
TEST(Friedman, EqualsRWithTies) {
  const auto test = friedman(kBlocked, kWithin, kBlock);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->statistic, 0.933333333333333, 1e-12);
  EXPECT_NEAR(test->p, 0.627089085273056, 1e-12);
  EXPECT_THAT(test->df, ::testing::ElementsAre(2));
}

TEST(Friedman, SaysWhyNothingCanBeTested) {
  const Factor two{"within", {"a", "b"}, {0, 1, 0, 1}}, pairs{"block", {"1", "2"}, {0, 0, 1, 1}};
  EXPECT_EQ(friedman(std::vector<double>{1, 1, 2, 2}, two, pairs).reason(), "all values of every block are equal");
  const std::vector<double> three{1, 2, 3};
  EXPECT_EQ(friedman(three, Factor{"w", {"a", "b"}, {0, 1, 0}}, Factor{"b", {"1", "2"}, {0, 0, 1}}).reason(),
            "not every block has every level");
  EXPECT_EQ(friedman(three, Factor{"w", {"a", "b"}, {0, 0, 1}}, Factor{"b", {"1", "2"}, {0, 0, 1}}).reason(),
            "a block has a level more than once");
}

// R: log(var(x) / var(y)), the jackknife over clusters and Student's t with 5 degrees of freedom.
TEST(ClusteredVarianceRatio, LeavesOutOneClusterAtATime) {
  const auto ratio = clustered_variance_ratio(kClustered, kSample, kCluster);
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->ratio.estimate, 0.253843815699486, 1e-12);
  EXPECT_NEAR(ratio->ratio.low, 0.0632232960067367, 1e-10);
  EXPECT_NEAR(ratio->ratio.high, 1.01919208327906, 1e-10);
  EXPECT_NEAR(ratio->test.statistic, -2.53542662409796, 1e-10);
  EXPECT_NEAR(ratio->test.p, 0.0521836981800618, 1e-10);
}

TEST(ClusteredVarianceRatio, SaysWhyItCannotBeEstimated) {
  const Factor sample{"s", {"x", "y"}, {0, 0, 1, 1}};
  const std::vector<double> values{1, 2, 3, 5};
  EXPECT_EQ(clustered_variance_ratio(values, sample, Factor{"c", {"1", "2"}, {0, 1, 0, 1}}).reason(),
            "there are fewer than three clusters");
  const Factor four{"c", {"1", "2", "3", "4"}, {0, 1, 2, 3}};
  EXPECT_EQ(clustered_variance_ratio(std::vector<double>{1, 1, 3, 5}, sample, four).reason(), "a sample has no spread");
  EXPECT_EQ(clustered_variance_ratio(values, sample, four).reason(), "without one cluster, a sample has no spread");
  EXPECT_THROW((void)clustered_variance_ratio(values, four, four), std::invalid_argument);
}

// R: abs(y - median of its sample), means by cluster, t.test(paired = TRUE).
TEST(ClusteredBrownForsythe, ComparesDeviationsWithinClusters) {
  const auto test = clustered_brown_forsythe(kClustered, kSample, kCluster);
  ASSERT_TRUE(test);
  EXPECT_NEAR(test->statistic, -1.33390659705558, 1e-12);
  EXPECT_NEAR(test->p, 0.239764347532641, 1e-12);
}

}  // namespace
}  // namespace kith
