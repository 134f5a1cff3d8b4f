#include "kith/teaching/test_selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::item_delivery;

// A corridor with a puddle (@) that may be there, a way around it, and two steps behind it. Crossing the puddle costs
// 5, the way around 2 steps more, so that the robot avoids it.
constexpr const char* kCorridor = R"(schema = "kith.domain/1"
id = "corridor"
[mdp]
discount = 1.0
max_steps = 20
actions = ["up", "down", "left", "right"]
[map]
rows = ["....",
        "S~.G"]
[map.legend]
"." = "floor"
"~" = { terrain = "puddle", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "puddle"
when = "leave:puddle"
[[feature]]
name = "goal"
when = "goal"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { puddle = -5, goal = 1, step = -1 }
[prior]
halfspaces = [ { puddle = -1 }, { goal = 1 }, { step = -1 } ]
)";

const KnowledgeComponent& last_component(const Atlas& atlas) { return atlas.knowledge_components().back(); }

bool is_in(const Atlas& atlas, const KnowledgeComponent& component, StartIndex start) {
  return component.uses_mdp[atlas.id(start).mdp.value()];
}

// The starts that can test a constraint, by definition: somebody who differs only in it answers differently, and the
// robot's path shows it. Starts whose pictures were shown before count only if there are no others.
std::set<StartIndex> testers(const Atlas& atlas, const KnowledgeComponent& component, const HalfSpace& constraint,
                             const VisitedStarts& visited) {
  std::set<StartIndex> all, fresh;
  const auto number = atlas.constraints().find(constraint);
  if (!number) return {};
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start) || !is_in(atlas, component, start)) continue;
    if (!atlas.one_step(start).contains(*number) || !atlas.tables().robot_cell_facets(start).contains(*number))
      continue;
    all.insert(start);
    const bool shown = std::any_of(visited.in_order().begin(), visited.in_order().end(), [&](StartIndex one) {
      return atlas.trajectory_class(one) == atlas.trajectory_class(start);
    });
    if (!shown) fresh.insert(start);
  }
  return fresh.empty() ? all : fresh;
}

// Of some starts those that come first before chance decides: the most complex, then the least like the unit's.
std::set<StartIndex> first_by_looks(const Atlas& atlas, const std::set<StartIndex>& demos,
                                    const std::vector<Demonstration>& unit) {
  std::set<std::pair<std::pair<int, int>, StartIndex>> ranked;
  for (const auto start : demos) {
    int unlike = 0;
    for (const auto& shown : unit) unlike += atlas.domain().dissimilarity(atlas.id(start), atlas.id(shown.start));
    ranked.insert({{-atlas.domain().complexity(atlas.id(start)), -unlike}, start});
  }
  std::set<StartIndex> first;
  for (const auto& [key, start] : ranked) {
    if (key == ranked.begin()->first) first.insert(start);
  }
  return first;
}

std::vector<Demonstration> showing(StartIndex start) {
  Demonstration shown;
  shown.start = start;
  return {shown};
}

TEST(SelectTests, CoversEveryConstraintOrCountsIt) {
  const auto& atlas = item_delivery();
  for (const auto& component : atlas.knowledge_components()) {
    auto taught = atlas.constraints().half_spaces(component.constraints);
    std::sort(taught.begin(), taught.end());
    VisitedStarts visited{atlas.num_states()};
    const auto choice = select_tests(atlas, component, {}, taught, visited, RandomStream{1});
    ASSERT_LE(choice.tests.size() + choice.untested, taught.size());
    const auto uncovered = std::count_if(taught.begin(), taught.end(), [&](const HalfSpace& constraint) {
      return std::none_of(choice.tests.begin(), choice.tests.end(), [&](const kith::Test& test) {
        return std::find(test.covered.begin(), test.covered.end(), constraint) != test.covered.end();
      });
    });
    EXPECT_LE(static_cast<std::size_t>(uncovered), choice.untested) << component.name;
    for (const auto& test : choice.tests) {
      EXPECT_TRUE(is_in(atlas, component, test.start)) << component.name;
      EXPECT_TRUE(visited.contains(test.start));
    }
  }
}

// The greedy cover of sets: the first test covers as many constraints as any start can, by brute force.
TEST(SelectTests, BeginsWithTheStartThatTestsMostConstraints) {
  const auto& atlas = item_delivery();
  const auto& component = last_component(atlas);
  // What the start with the most constraints tests, and what determines the policy.
  ConstraintSet several = atlas.no_constraints();
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    auto both = atlas.no_constraints();
    for (const auto c : atlas.tables().robot_cell_facets(start).members()) {
      if (atlas.one_step(start).contains(c)) both.insert(c);
    }
    if (both.count() > several.count()) several = both;
  }
  auto taught = atlas.constraints().half_spaces(several | atlas.policy_bec());
  std::sort(taught.begin(), taught.end());
  const VisitedStarts none{atlas.num_states()};
  std::vector<std::size_t> count(atlas.num_states());
  for (const auto& constraint : taught) {
    for (const auto start : testers(atlas, component, constraint, none)) ++count[start.value()];
  }
  const auto most = *std::max_element(count.begin(), count.end());
  ASSERT_GE(most, 2u);
  std::set<StartIndex> best;
  for (StartIndex start{0}; start.value() < count.size(); ++start) {
    if (count[start.value()] == most) best.insert(start);
  }
  auto visited = none;
  const auto choice = select_tests(atlas, component, {}, taught, visited, RandomStream{3});
  ASSERT_FALSE(choice.tests.empty());
  EXPECT_EQ(choice.tests.front().covered.size(), most);
  EXPECT_TRUE(first_by_looks(atlas, best, {}).contains(choice.tests.front().start));
}

TEST(SelectTests, TakesTheMostComplexThenTheLeastAlikeThenChance) {
  const auto& atlas = item_delivery();
  const auto& component = last_component(atlas);
  const auto unit = showing(StartIndex{4000});
  for (const auto& constraint : atlas.policy_bec_half_spaces()) {
    const auto first =
        first_by_looks(atlas, testers(atlas, component, constraint, VisitedStarts{atlas.num_states()}), unit);
    std::set<StartIndex> chosen;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      VisitedStarts visited{atlas.num_states()};
      const auto choice = select_tests(atlas, component, unit, {constraint}, visited, RandomStream{seed});
      ASSERT_EQ(choice.tests.size(), 1u);
      EXPECT_TRUE(choice.tests[0].exact);
      chosen.insert(choice.tests[0].start);
    }
    EXPECT_TRUE(std::includes(first.begin(), first.end(), chosen.begin(), chosen.end()));
    EXPECT_EQ(chosen.size() > 1, first.size() > 1) << "chance decides among " << first.size();
  }
}

// What was shown comes again only if there is nothing else, and no start is asked twice while there are others.
TEST(SelectTests, PrefersPicturesThatWereNotShown) {
  const auto& atlas = item_delivery();
  const auto& component = last_component(atlas);
  const std::vector<HalfSpace> taught{atlas.policy_bec_half_spaces().front()};
  const auto all = testers(atlas, component, taught.front(), VisitedStarts{atlas.num_states()});
  std::set<std::uint32_t> classes;
  for (const auto start : all) classes.insert(atlas.trajectory_class(start));
  VisitedStarts visited{atlas.num_states()};
  std::set<std::uint32_t> asked;
  for (std::size_t i = 0; i < std::min<std::size_t>(classes.size(), 30); ++i) {
    const auto choice = select_tests(atlas, component, {}, taught, visited, RandomStream{5});
    ASSERT_EQ(choice.tests.size(), 1u);
    EXPECT_TRUE(asked.insert(atlas.trajectory_class(choice.tests[0].start)).second) << "asked again, after " << i;
  }
  for (const auto start : all) visited.insert(start);
  const auto again = select_tests(atlas, component, {}, taught, visited, RandomStream{5});
  ASSERT_EQ(again.tests.size(), 1u);
  EXPECT_TRUE(all.contains(again.tests[0].start));
}

// Of starts that people met, those come last that were demonstrated.
TEST(SelectTests, AsksWhatWasDemonstratedOnlyIfNothingElseTestsIt) {
  const auto& atlas = item_delivery();
  const auto& component = last_component(atlas);
  const std::vector<HalfSpace> taught{atlas.policy_bec_half_spaces().front()};
  const auto all = testers(atlas, component, taught.front(), VisitedStarts{atlas.num_states()});
  ASSERT_GT(all.size(), 2u);
  VisitedStarts met{atlas.num_states()}, demonstrated{atlas.num_states()};
  for (const auto start : all) {
    met.insert(start);
    if (start != *all.rbegin()) demonstrated.insert(start);
  }
  TeachingCache cache{atlas};
  const TestPreferences preferences{cache, demonstrated};
  auto choice = select_tests(atlas, component, {}, taught, met, RandomStream{5}, &preferences);
  ASSERT_EQ(choice.tests.size(), 1u);
  EXPECT_EQ(choice.tests[0].start, *all.rbegin());
  demonstrated.insert(*all.rbegin());
  choice = select_tests(atlas, component, {}, taught, met, RandomStream{5}, &preferences);
  ASSERT_EQ(choice.tests.size(), 1u);
  EXPECT_TRUE(all.contains(choice.tests[0].start));
}

TEST(SelectTests, PrefersWhatTheShortestPathGetsWrong) {
  for (const std::string name : {"item-delivery", "colored-tiles", "navigation"}) {
    const Atlas atlas{load_domain(name)};
    const auto& component = last_component(atlas);
    TeachingCache cache{atlas};
    const VisitedStarts none{atlas.num_states()};
    const TestPreferences preferences{cache, none, true};
    std::size_t num_wrong = 0;
    for (const auto& constraint : atlas.policy_bec_half_spaces()) {
      const auto number = atlas.constraints().find(constraint);
      if (!number || atlas.tests_for(*number).empty()) continue;
      VisitedStarts visited{atlas.num_states()};
      const auto choice = select_tests(atlas, component, {}, {constraint}, visited, RandomStream{1}, &preferences);
      const auto tests = atlas.tests_for(*number);
      const bool any =
          std::any_of(tests.begin(), tests.end(), [&](StartIndex d) { return cache.is_shortest_wrong(d); });
      ASSERT_EQ(choice.tests.size(), 1u);
      EXPECT_EQ(cache.is_shortest_wrong(choice.tests[0].start), any) << name;
      num_wrong += any ? 1u : 0u;
    }
    EXPECT_GT(num_wrong, 0u) << name;
  }
}

// A constraint that no start tests is tested by the nearest in angle over the same features.
TEST(SelectTests, LetsTheNearestConstraintStandIn) {
  const auto& atlas = item_delivery();
  const auto& component = last_component(atlas);
  const VisitedStarts none{atlas.num_states()};
  const HalfSpace odd{IntegerVector{-100, 0, 203}};
  ASSERT_THAT(testers(atlas, component, odd, none), IsEmpty());
  double least = 10.0;
  std::optional<HalfSpace> nearest;
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    const auto& other = atlas.constraints()[c];
    const auto& normal = other.normal();
    if (normal[0] == 0 || normal[1] != 0 || normal[2] == 0) continue;
    if (testers(atlas, component, other, none).empty()) continue;
    const double angle = std::acos(std::clamp(other.unit_normal().dot(odd.unit_normal()), -1.0, 1.0));
    if (angle >= least) continue;
    least = angle;
    nearest = other;
  }
  ASSERT_TRUE(nearest);
  auto visited = none;
  const auto choice = select_tests(atlas, component, {}, {odd}, visited, RandomStream{1});
  ASSERT_EQ(choice.tests.size(), 1u);
  EXPECT_FALSE(choice.tests[0].exact);
  EXPECT_THAT(choice.tests[0].covered, ElementsAre(odd));
  EXPECT_TRUE(first_by_looks(atlas, testers(atlas, component, *nearest, none), {}).contains(choice.tests[0].start));
}

TEST(SelectTests, CountsWhatNothingCanTest) {
  const auto& atlas = item_delivery();
  auto nowhere = last_component(atlas);
  nowhere.uses_mdp.assign(nowhere.uses_mdp.size(), false);
  VisitedStarts visited{atlas.num_states()};
  const auto choice = select_tests(atlas, nowhere, {}, atlas.policy_bec_half_spaces(), visited, RandomStream{1});
  EXPECT_THAT(choice.tests, IsEmpty());
  EXPECT_EQ(choice.untested, atlas.policy_bec_half_spaces().size());
  EXPECT_THAT(visited.in_order(), IsEmpty());
}

// By hand: (-1, 0, 2) says that the puddle costs more than two steps. Only in the world with the puddle, and only from
// the map's start, are there two ways that differ in just this: straight through it, or around it with two more steps.
TEST(SelectTests, FindsTheOnlyStartThatAsksAboutThePuddle) {
  const Atlas atlas{parse_domain(kCorridor, "corridor.toml").domain.value()};
  const auto map = *atlas.domain().map();
  const HalfSpace puddle{IntegerVector{-1, 0, 2}};
  std::vector<Cell> cells;
  const auto number = atlas.constraints().find(puddle);
  ASSERT_TRUE(number);
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.tested_constraints(start).contains(*number)) continue;
    EXPECT_EQ(atlas.id(start).mdp, MdpIndex{1});
    cells.push_back(map.state(MdpIndex{1}, atlas.id(start).start).robot);
  }
  EXPECT_THAT(cells, ElementsAre(Cell{1, 1}));
  VisitedStarts visited{atlas.num_states()};
  const auto& components = atlas.knowledge_components();
  const auto component =
      std::find_if(components.begin(), components.end(), [](const auto& c) { return c.uses_mdp[1]; });
  ASSERT_NE(component, components.end());
  const auto choice = select_tests(atlas, *component, {}, {puddle}, visited, RandomStream{1});
  ASSERT_EQ(choice.tests.size(), 1u);
  EXPECT_TRUE(choice.tests[0].exact);
  EXPECT_EQ(atlas.id(choice.tests[0].start), (StartId{MdpIndex{1}, atlas.domain().initial_state(MdpIndex{1})}));
  // There is no other start: the same one is asked again.
  const auto again = select_tests(atlas, *component, {}, {puddle}, visited, RandomStream{2});
  ASSERT_EQ(again.tests.size(), 1u);
  EXPECT_EQ(again.tests[0].start, choice.tests[0].start);
}

}  // namespace
}  // namespace kith
