// What kith bench times is the same as what its rivals do, and its figures are what they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "kith/domains/domain_file.hpp"
#include "naive_counterfactuals.hpp"
#include "naive_filter.hpp"
#include "suite.hpp"

namespace kith::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(BenchFigure, IsMedianAndQuartiles) {
  const auto odd = figure_of({5.0, 1.0, 2.0, 4.0, 3.0});
  EXPECT_EQ(odd.median, 3.0);
  EXPECT_EQ(odd.low, 2.0);
  EXPECT_EQ(odd.high, 4.0);
  EXPECT_EQ(odd.samples, 5u);
  EXPECT_NEAR(odd.spread(), 1.0 / 3.0, 1e-15);
  const auto even = figure_of({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(even.median, 2.5);
  EXPECT_EQ(even.low, 1.75);
  EXPECT_EQ(even.high, 3.25);
  EXPECT_EQ(figure_of({}).samples, 0u);
  EXPECT_EQ(figure_of({7.0}).spread(), 0.0);
}

TEST(BenchMeasure, TakesTurnsBetweenWorkAndRival) {
  std::string turns;
  Effort effort;
  effort.seconds = 0.0;
  effort.min_samples = 3;
  effort.warm_up = false;
  effort.sample_seconds = 0.0;  // one round a sample
  const auto timings = measure([&](std::size_t n) { turns += std::string(n, 'a'); },
                               [&](std::size_t n) { turns += std::string(n, 'b'); }, effort);
  EXPECT_EQ(timings.work.cpu.samples, 3u);
  ASSERT_TRUE(timings.rival);
  EXPECT_EQ(timings.rival->wall.samples, 3u);
  EXPECT_THAT(turns, ::testing::EndsWith("ababab"));
}

TEST(BenchMeasure, EndsWhenAskedTo) {
  Effort effort;
  effort.stopped = [] { return true; };
  effort.sample_seconds = 0.0;
  EXPECT_EQ(measure([](std::size_t) {}, {}, effort).work.cpu.samples, 1u);
}

TEST(BenchGrowth, HasTheExponentOfAPower) {
  EXPECT_NEAR(growth_exponent({1.0, 2.0, 8.0}, {3.0, 12.0, 192.0}), 2.0, 1e-12);
  EXPECT_NEAR(growth_exponent({10.0, 20.0}, {5.0, 5.0}), 0.0, 1e-12);
}

TEST(BenchCases, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const auto& one : all_cases()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_FALSE(one.what.empty()) << one.name;
  }
  for (const auto& one : all_growths()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_GE(one.points.size(), 3u) << one.name;
  }
}

// Studies take longer: their tables on one thread and on several are compared by other tests.
TEST(BenchCases, AgreeWithTheirRivals) {
  Workbench bench{2};
  for (const auto& one : all_cases()) {
    if (one.is_study) continue;
    const auto prepared = one.prepare(bench);
    EXPECT_EQ(static_cast<bool>(prepared.rival), !one.rival.empty()) << one.name;
    EXPECT_EQ(static_cast<bool>(prepared.rival), static_cast<bool>(prepared.disagreement)) << one.name;
    if (prepared.disagreement) {
      EXPECT_EQ(prepared.disagreement(), "") << one.name;
    }
    prepared.work(2);
    if (prepared.rival) prepared.rival(1);
  }
}

TEST(NaiveCounterfactuals, TellPeopleApart) {
  const Atlas atlas{load_domain("item-delivery")};
  const NaiveCounterfactuals naive{atlas};
  // The robot itself has nothing to learn; somebody who likes rubble has no finite optimum where there is any.
  const std::vector<Eigen::Vector3d> robot{atlas.domain().weights().unit};
  for (const auto& list : naive.conveyed(robot)) ASSERT_THAT(list, IsEmpty());
  const std::vector<Eigen::Vector3d> hasty{Eigen::Vector3d{-0.1, 0.1, -1.0}.normalized()};
  std::size_t found = 0;
  for (const auto& list : naive.conveyed(hasty)) found += list.size();
  EXPECT_GT(found, 0u);
}

TEST(NaiveFilter, IsABayesUpdate) {
  const std::vector<HalfSpace> prior{HalfSpace{{0, 0, -1}}}, seen{HalfSpace{{1, 0, 0}}};
  const ParticleBelief start{Cone::intersection(prior).value(), {.resample_below = 0.0}};
  NaiveFilter filter{start, prior, RandomStream{1}};
  const HalfSpaceLikelihood likelihood{0.8};
  filter.observe(seen, likelihood);
  double sum = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) sum += likelihood.density(start.point(i).x());
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_NEAR(filter.weights()[i], likelihood.density(start.point(i).x()) / sum, 1e-15);
}

}  // namespace
}  // namespace kith::bench
