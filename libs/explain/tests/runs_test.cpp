#include "kith/explain/runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "atlases.hpp"
#include "lake.hpp"

namespace kith {
namespace {

using testing::atlas_of;

// Runs keep to the robot's policy and to outcomes that can follow.
void expect_possible(const Atlas& atlas, StartIndex start, const PolicyRun& run) {
  const auto world = atlas.id(start).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  ASSERT_EQ(run.path.states.front(), atlas.id(start).start);
  ASSERT_EQ(run.path.states.size(), run.path.actions.size() + 1);
  EXPECT_EQ(run.has_ended, mdp.is_terminal(run.path.states.back()));
  for (std::size_t t = 0; t < run.path.actions.size(); ++t) {
    const auto s = run.path.states[t];
    EXPECT_EQ(run.path.actions[t], atlas.trajectory(atlas.index({world, s})).actions.front());
    const auto choice = std::ranges::find(mdp.choices(s), run.path.actions[t], &Choice::action);
    const auto outcomes = mdp.outcomes(*choice);
    EXPECT_TRUE(std::ranges::any_of(outcomes, [&](const Outcome& o) { return o.next == run.path.states[t + 1]; }));
  }
}

TEST(Runs, AreRunsOfThePolicyAsOutcomesFall) {
  const auto& atlas = atlas_of(testing::slippery_lake("steps", "{ step = -1 }", "1.0"));
  RandomStream random{1}, again{1};
  const auto runs = several_runs(atlas, StartIndex{0}, 10, random);
  ASSERT_EQ(runs.size(), 10u);
  EXPECT_GT(different_ways(runs).size(), 1u);  // never only the likeliest path
  for (const auto& run : runs) expect_possible(atlas, StartIndex{0}, run);
  const auto same = several_runs(atlas, StartIndex{0}, 10, again);
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(same[i].path.states, runs[i].path.states);
}

TEST(Runs, AreLeftOutWhereNothingIsLeftToChance) {
  RandomStream random{1};
  EXPECT_TRUE(several_runs(atlas_of("item-delivery"), StartIndex{0}, 10, random).empty());
}

TEST(Runs, KeepAwayFromStatesThatWeightsDoNotExplain) {
  const std::filesystem::path lake = testing::slippery_lake("inferred", "{ step = -1 }", "1.0");
  std::ofstream{lake, std::ios::app} << "[inferred]\nshare = 0.9\nnot_explained = [[0, 8]]\n";
  const auto meets = [](const PolicyRun& run) {
    return std::ranges::any_of(run.path.states, [](StateIndex s) { return s.value() == 8; });
  };
  RandomStream random{1};
  const auto whole =
      several_runs(atlas_of(testing::slippery_lake("steps", "{ step = -1 }", "1.0")), StartIndex{0}, 50, random);
  EXPECT_TRUE(std::ranges::any_of(whole, meets));
  const auto runs = several_runs(atlas_of(lake.string()), StartIndex{0}, 10, random);
  EXPECT_FALSE(runs.empty());
  EXPECT_TRUE(std::ranges::none_of(runs, meets));
}

TEST(Runs, AreChosenByTheirLength) {
  std::vector<PolicyRun> runs;
  for (const std::size_t length : {9u, 2u, 7u, 4u, 5u, 6u, 3u, 8u, 1u, 10u}) {
    runs.push_back({{std::vector<StateIndex>(length + 1), std::vector<ActionIndex>(length)}, {}, true});
  }
  const auto lengths = [](const std::vector<PolicyRun>& all) {
    std::vector<std::size_t> list;
    for (const auto& run : all) list.push_back(run.path.actions.size());
    return list;
  };
  EXPECT_EQ(lengths(typical_runs(runs)), (std::vector<std::size_t>{6, 4, 8, 2, 10}));
  runs.resize(2);
  EXPECT_EQ(lengths(typical_runs(runs)), (std::vector<std::size_t>{9, 2}));
  EXPECT_TRUE(typical_runs({}).empty());
}

// Expected shares within four standard errors.
TEST(Runs, FallAsOftenAsTheModelSays) {
  const auto& atlas = atlas_of(testing::slippery_lake("steps", "{ step = -1 }", "1.0"));
  const auto& domain = atlas.domain();
  RandomStream random{3};
  constexpr std::size_t kRuns = 2000;
  const auto runs = several_runs(atlas, StartIndex{0}, kRuns, random);
  std::size_t falls = 0;
  for (const auto& run : runs) {
    if (run.times[0] > 0) ++falls;
  }
  const double expected =
      static_cast<double>(atlas.feature_counts(StartIndex{0})[0]) / static_cast<double>(domain.count_scale());
  EXPECT_NEAR(static_cast<double>(falls) / kRuns, expected, 4.0 * 0.5 / std::sqrt(static_cast<double>(kRuns)));
}

TEST(Runs, AreCountedInWords) {
  const auto& domain = atlas_of(testing::slippery_lake("steps", "{ step = -1 }", "1.0")).domain();
  const auto run = [](std::int64_t falls, std::size_t action) {
    PolicyRun result;
    result.path = Trajectory{{StateIndex{0}, StateIndex{1}}, {ActionIndex{action}}};
    result.times = IntegerVector{falls, 1 - falls, 1};
    result.has_ended = true;
    return result;
  };
  EXPECT_EQ(runs_in_words(domain, MdpIndex{0}, {run(1, 0), run(0, 1), run(0, 1)}),
            "falling into a hole in 1 of 3 runs and reaching the goal in 2; the same path in 2 of 3 runs");
  EXPECT_EQ(runs_in_words(domain, MdpIndex{0}, {run(0, 1), run(0, 1)}), "the same path in all 2 runs");
  EXPECT_EQ(runs_in_words(domain, MdpIndex{0}, {run(0, 1), run(0, 2)}), "a different path in each of 2 runs");
  auto endless = run(0, 2);
  endless.has_ended = false;
  EXPECT_EQ(runs_in_words(domain, MdpIndex{0}, {run(1, 1), endless}),
            "falling into a hole in 1 of 2 runs and reaching the goal in 1; 1 of 2 runs not finished within 200 steps; "
            "a different path in each of 2 runs");
}

}  // namespace
}  // namespace kith
