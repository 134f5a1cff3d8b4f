#include "kith/teaching/demonstration_selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "item_delivery.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

using ::testing::IsEmpty;
using testing::item_delivery;

constexpr std::size_t kParticles = 500;
constexpr double kSameArea = 1e-5;  // relative; the rule of ties of the selection

ParticleBelief initial_belief() {
  return {item_delivery().prior_cone(), FilterOptions{.particles = kParticles, .resample_below = 0.0}};
}

std::vector<HalfSpace> prior_region() { return item_delivery().prior_cone().minimal_set(); }

Unit selected_unit(const ParticleBelief& belief, const KnowledgeComponent& component, std::span<const HalfSpace> taught,
                   const VisitedStarts& visited, std::uint64_t seed) {
  TeachingCache cache{item_delivery()};
  return select_demonstrations(cache, belief, component, taught, visited, {}, RandomStream{seed});
}

double area_of(const std::vector<HalfSpace>& half_spaces) {
  return Cone::intersection(half_spaces).value().solid_angle();
}

// --- counterfactuals ------------------------------------------------------------

TEST(SampleCounterfactuals, GivesEachBehaviourOnceWithAParticleThatHasIt) {
  Behaviours behaviours{item_delivery()};
  const auto belief = initial_belief();
  for (const auto sampling : {CounterfactualSampling::kSystematic, CounterfactualSampling::kSpread}) {
    std::vector<std::size_t> particles;
    const auto cells = sample_counterfactuals(behaviours, belief, {.counterfactuals = 20, .sampling = sampling},
                                              RandomStream{4}, &particles);
    ASSERT_EQ(cells.size(), particles.size());
    EXPECT_LE(cells.size(), 20u);
    EXPECT_GT(cells.size(), 1u);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    std::set<PolicyCellIndex> of_particles;
    for (const auto i : particles) of_particles.insert(behaviours.locate(belief.point(i)));
    EXPECT_EQ(of_particles, std::set<PolicyCellIndex>(cells.begin(), cells.end()));
  }
}

TEST(SampleCounterfactuals, IsOneCellForABeliefThatIsOne) {
  Behaviours behaviours{item_delivery()};
  auto belief = initial_belief();
  belief.observe(item_delivery().policy_bec_half_spaces(), HalfSpaceLikelihood{1.0 - 1e-9}, RandomStream{1});
  const auto cells = sample_counterfactuals(behaviours, belief, {.counterfactuals = 50}, RandomStream{2});
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells.front(), behaviours.locate(item_delivery().domain().weights().unit));
}

// --- demonstrations -------------------------------------------------------------

// The rule by brute force: every start of the component by what it would convey, and by how it looks.
struct Ranked {
  std::size_t num_new = 0;
  double gain = 0.0;
  int complexity = 0;
  int unlike = 0;
};

std::map<StartIndex, Ranked> ranked_starts(const KnowledgeComponent& component, std::span<const PolicyCellIndex> cells,
                                           const std::vector<HalfSpace>& taught, const VisitedStarts& visited) {
  const auto& atlas = item_delivery();
  std::map<StartClassIndex, Ranked> of_class;
  for (const auto c : component.start_classes) {
    auto both = taught;
    for (const auto& half_space : atlas.constraints().half_spaces(atlas.tables().conveyed(c, cells)))
      both.push_back(half_space);
    const auto left = Cone::intersection(both).value();
    Ranked ranked;
    ranked.gain = area_of(taught) / left.solid_angle();
    for (const auto& facet : left.facets()) {
      ranked.num_new += std::find(taught.begin(), taught.end(), facet) == taught.end() ? 1u : 0u;
    }
    if (ranked.gain > 1.0 + 1e-6) of_class.emplace(c, ranked);
  }
  std::map<StartIndex, Ranked> result;
  for (auto& [c, ranked] : of_class) {
    for (const auto start : atlas.members(c)) {
      if (visited.contains(start)) continue;
      ranked.complexity = atlas.domain().complexity(atlas.id(start));
      ranked.unlike = atlas.mean_dissimilarity(start);
      result.emplace(start, ranked);
    }
  }
  return result;
}

// Those that come first before chance decides: fewest new facets, then the largest gain, then the simplest picture,
// then the most typical one of its world.
std::set<StartIndex> best_of(const std::map<StartIndex, Ranked>& ranked) {
  std::size_t fewest = ranked.begin()->second.num_new;
  for (const auto& [start, one] : ranked) fewest = std::min(fewest, one.num_new);
  double gain = 0.0;
  for (const auto& [start, one] : ranked) gain = one.num_new == fewest ? std::max(gain, one.gain) : gain;
  std::set<std::tuple<int, int, StartIndex>> equal;
  for (const auto& [start, one] : ranked) {
    if (one.num_new == fewest && one.gain >= gain * (1.0 - kSameArea))
      equal.insert({one.complexity, one.unlike, start});
  }
  std::set<StartIndex> best;
  const auto [complexity, unlike, first] = *equal.begin();
  for (const auto& [c, u, start] : equal) {
    if (c == complexity && u == unlike) best.insert(start);
  }
  return best;
}

TEST(SelectDemonstrations, BeginsWithFewNewFactsThenGainThenSimplicity) {
  const auto& atlas = item_delivery();
  const auto belief = initial_belief();
  const auto taught = prior_region();
  const VisitedStarts none{atlas.num_states()};
  for (const auto& component : atlas.knowledge_components()) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto unit = selected_unit(belief, component, taught, none, seed);
      if (unit.demonstrations.empty()) continue;
      Behaviours behaviours{atlas};
      // The stream of the first step's counterfactuals.
      const auto cells = sample_counterfactuals(behaviours, belief, {},
                                                RandomStream{seed}.split(std::uint64_t{0}).split("counterfactuals"));
      const auto ranked = ranked_starts(component, cells, taught, none);
      ASSERT_FALSE(ranked.empty());
      const auto& first = unit.demonstrations.front();
      EXPECT_TRUE(best_of(ranked).contains(first.start)) << component.name << ", seed " << seed;
      EXPECT_EQ(first.num_new, ranked.at(first.start).num_new);
      EXPECT_NEAR(first.gain / ranked.at(first.start).gain, 1.0, 1e-9);
    }
  }
}

// Gains are ratios of areas, so those of a unit multiply to what the whole unit leaves of the region.
TEST(SelectDemonstrations, EachAddsSomethingAndTogetherTheyGiveTheTaughtRegion) {
  const auto& atlas = item_delivery();
  for (const auto& component : atlas.knowledge_components()) {
    const auto unit = selected_unit(initial_belief(), component, prior_region(), VisitedStarts{atlas.num_states()}, 7);
    double gain = 1.0;
    auto all = prior_region();
    std::set<StartIndex> demos;
    for (const auto& shown : unit.demonstrations) {
      EXPECT_GT(shown.gain, 1.0);
      EXPECT_GT(shown.num_new, 0u);
      EXPECT_TRUE(demos.insert(shown.start).second) << "shown twice";
      EXPECT_TRUE(component.uses_mdp[atlas.id(shown.start).mdp.value()]);
      EXPECT_FALSE(shown.counterfactuals.empty());
      for (const auto& half_space : shown.half_spaces) {
        EXPECT_TRUE(half_space.contains(atlas.domain().weights().integer));
        all.push_back(half_space);
      }
      gain *= shown.gain;
    }
    EXPECT_EQ(unit.taught_region, Cone::intersection(all).value().minimal_set());
    EXPECT_NEAR(gain * area_of(unit.taught_region) / area_of(prior_region()), 1.0, 1e-6);
  }
}

TEST(SelectDemonstrations, NeverShowsWhatWasVisited) {
  const auto& atlas = item_delivery();
  const auto& component = atlas.knowledge_components().front();
  VisitedStarts visited{atlas.num_states()};
  std::set<StartIndex> shown;
  for (int round = 0; round < 5; ++round) {
    const auto unit = selected_unit(initial_belief(), component, prior_region(), visited, 11);
    ASSERT_FALSE(unit.demonstrations.empty());
    for (const auto& one : unit.demonstrations) {
      EXPECT_TRUE(shown.insert(one.start).second) << "shown in an earlier unit";
      visited.insert(one.start);
    }
  }
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) visited.insert(start);
  EXPECT_THAT(selected_unit(initial_belief(), component, prior_region(), visited, 11).demonstrations, IsEmpty());
}

TEST(SelectDemonstrations, IsEmptyWhereNothingHasGain) {
  const auto& atlas = item_delivery();
  auto taught = prior_region();
  for (const auto& half_space : atlas.policy_bec_half_spaces()) taught.push_back(half_space);
  taught = Cone::intersection(taught).value().minimal_set();
  const auto unit = selected_unit(initial_belief(), atlas.knowledge_components().back(), taught,
                                  VisitedStarts{atlas.num_states()}, 1);
  EXPECT_THAT(unit.demonstrations, IsEmpty());
  EXPECT_EQ(unit.taught_region, taught);
}

TEST(SelectDemonstrations, DependsOnTheStreamAlone) {
  const VisitedStarts none{item_delivery().num_states()};
  TeachingCache used{item_delivery()};
  for (const auto& component : item_delivery().knowledge_components()) {
    auto unknown = component;
    unknown.conveyed.reset();
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const RandomStream random{seed};
      EXPECT_EQ(
          select_demonstrations(used, initial_belief(), component, prior_region(), none, {}, random).demonstrations,
          selected_unit(initial_belief(), unknown, prior_region(), none, seed).demonstrations);
    }
  }
}

}  // namespace
}  // namespace kith
