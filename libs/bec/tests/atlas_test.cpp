#include "kith/bec/atlas.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "item_delivery.hpp"
#include "kith/core/distributions.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/coverage_set.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using testing::half_spaces;
using testing::item_delivery;

Eigen::Vector3d random_weights(RandomStream& random) { return Cone{}.sample(random); }

// The facts of the paper's domain.

TEST(ItemDelivery, HasItsPublishedSize) {
  const auto& atlas = item_delivery();
  EXPECT_EQ(atlas.domain().num_mdps(), 64u);
  EXPECT_EQ(atlas.num_states(), 9312u);
  std::size_t ties = 0;
  std::size_t unique = 0;
  std::size_t shortest = std::numeric_limits<std::size_t>::max();
  std::size_t longest = 0;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    ties += atlas.has_tie(start) ? 1u : 0u;
    unique += atlas.is_unique(start) ? 1u : 0u;
    const auto length = atlas.trajectory(start).actions.size();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  EXPECT_EQ(ties, 1526u);
  EXPECT_EQ(unique, 6182u);
  EXPECT_EQ(shortest, 1u);
  EXPECT_EQ(longest, 14u);
}

TEST(ItemDelivery, HasThePublishedBec) {
  const auto& atlas = item_delivery();
  EXPECT_EQ(atlas.policy_bec_half_spaces(), half_spaces({{-1, 0, 2}, {0, -1, -4}, {1, 1, 0}}));
  EXPECT_NEAR(atlas.policy_bec_area_sr(), 0.0260947, 1e-6);
}

TEST(ItemDelivery, HasThreeKnowledgeComponents) {
  const auto& atlas = item_delivery();
  const auto& components = atlas.knowledge_components();
  ASSERT_EQ(components.size(), 3u);
  EXPECT_THAT(atlas.mask_counters(), ElementsAre(9480u, 1767u, 15979u));
  const auto uses = [](const KnowledgeComponent& c) { return std::count(c.uses_mdp.begin(), c.uses_mdp.end(), true); };

  EXPECT_EQ(components[0].masked, (std::vector<std::size_t>{1}));
  EXPECT_EQ(components[0].name, "rubble");
  EXPECT_EQ(uses(components[0]), 32);
  EXPECT_EQ(atlas.constraints().half_spaces(components[0].constraints), half_spaces({{-1, 0, 2}, {1, 0, -4}}));
  EXPECT_NEAR(components[0].area_sr, 0.437338, 1e-6);

  EXPECT_EQ(components[1].masked, (std::vector<std::size_t>{0}));
  EXPECT_EQ(components[1].name, "recharge");
  EXPECT_EQ(uses(components[1]), 2);
  EXPECT_EQ(atlas.constraints().half_spaces(components[1].constraints), half_spaces({{0, 1, 2}, {0, -1, -4}}));
  EXPECT_NEAR(components[1].area_sr, 0.437338, 1e-6);

  EXPECT_TRUE(components[2].masked.empty());
  EXPECT_EQ(components[2].name, "rubble+recharge");
  EXPECT_EQ(uses(components[2]), 64);
  EXPECT_EQ(components[2].constraints, atlas.policy_bec());

  Regions regions{atlas.constraints()};
  EXPECT_NEAR(regions.of(atlas.prior() | components[0].constraints | components[1].constraints).area_sr, 0.052189,
              1e-6);
}

TEST(ItemDelivery, HasTheKnownCoverageSets) {
  const auto& coverage = item_delivery().tables().coverage();
  EXPECT_EQ(coverage.vertices, 19324u);
  EXPECT_NEAR(coverage.mean, 2.08, 0.005);
  EXPECT_EQ(coverage.max, 7u);
}

TEST(ItemDelivery, NeedsFewConstraintsAndPolicyCells) {
  EXPECT_EQ(item_delivery().constraints().size(), 64u);
  EXPECT_EQ(item_delivery().tables().cells().size(), 241u);
}

// Laws.

TEST(Atlas, EveryConstraintThatIsConveyedHoldsAtTheRobotsWeights) {
  const auto& atlas = item_delivery();
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    EXPECT_GE(sign_of_dot(atlas.constraints()[c].normal(), atlas.domain().weights().integer), 0)
        << to_string(atlas.constraints()[c].normal());
  }
}

TEST(Atlas, ThePolicysBecImpliesEveryOneStepAndCounterfactualConstraint) {
  const auto& atlas = item_delivery();
  const auto bec = Cone::intersection(atlas.policy_bec_half_spaces());
  ASSERT_TRUE(bec.has_value());
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    EXPECT_TRUE(bec->implies(atlas.constraints()[c])) << to_string(atlas.constraints()[c].normal());
  }
}

TEST(Atlas, CanDoWithoutSomeTests) {
  const auto& atlas = item_delivery();
  std::vector<bool> is_usable(atlas.num_states());
  for (std::size_t i = 0; i < is_usable.size(); ++i) is_usable[i] = i % 2 == 0;
  const auto fewer = atlas.with_tests(is_usable);
  std::size_t left_out = 0;
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    std::vector<StartIndex> expected;
    for (const auto start : atlas.tests_for(c)) {
      if (start.value() % 2 == 0) expected.push_back(start);
    }
    left_out += atlas.tests_for(c).size() - expected.size();
    const auto tests = fewer.tests_for(c);
    EXPECT_EQ(std::vector<StartIndex>(tests.begin(), tests.end()), expected);
  }
  EXPECT_GT(left_out, 0u);
  is_usable.pop_back();
  EXPECT_THROW((void)atlas.with_tests(is_usable), std::invalid_argument);
}

TEST(Atlas, IndexAndIdAreInverse) {
  const auto& atlas = item_delivery();
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) ASSERT_EQ(atlas.index(atlas.id(start)), start);
}

TEST(Atlas, ClassesPartitionTheDemonstrations) {
  const auto& atlas = item_delivery();
  std::size_t members = 0;
  for (StartClassIndex c{0}; c.value() < atlas.num_start_classes(); ++c) {
    for (const auto start : atlas.members(c)) ASSERT_EQ(atlas.start_class(start), c);
    members += atlas.members(c).size();
  }
  EXPECT_EQ(members, atlas.num_states());
}

// A learner's answer by look-up is the best of the coverage set under the
// weights, for 100 random weights x all starts; weights outside the finite
// region have no answer.
TEST(Atlas, AnswersAreTheBestOfTheCoverageSet) {
  const auto& atlas = item_delivery();
  RandomStream random{20240617};
  std::array<std::vector<double>, 3> points;
  std::vector<std::uint32_t> cells;
  for (int i = 0; i < 100; ++i) {
    auto w = random_weights(random);
    if (i % 2 == 0) w.z() = -std::abs(w.z());  // half of them where optima are finite
    const auto cell = atlas.tables().cells().locate(w);
    for (std::size_t k = 0; k < 3; ++k) points[k].push_back(w[static_cast<Eigen::Index>(k)]);
    cells.push_back(static_cast<std::uint32_t>(cell.value()));
    for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
      const auto answer = atlas.tables().answer(start, cell);
      ASSERT_EQ(answer.has_value(), atlas.tables().finite_region(start).contains(w));
      if (!answer) continue;
      const std::array<double, 3> x{w.x(), w.y(), w.z()};
      double best = -std::numeric_limits<double>::infinity();
      for (const auto& vertex : atlas.tables().coverage_set(start)) best = std::max(best, dot(vertex, x));
      ASSERT_NEAR(dot(*answer, x), best, 1e-12);
    }
  }
  EXPECT_EQ(atlas.tables().cells().locate(points[0], points[1], points[2]), cells);
}

// The hull maximum is the value that planning finds, wherever the optimum is
// finite, in every MDP from every start. Returns how many MDPs had one.
std::size_t expect_hull_maximum_is_planned(int num_weights) {
  const auto& atlas = item_delivery();
  RandomStream random{77};
  std::size_t finite = 0;
  for (int i = 0; i < num_weights; ++i) {
    const auto w = random_weights(random);
    const std::array<double, 3> x{w.x(), w.y(), w.z()};
    for (MdpIndex m{0}; m.value() < atlas.domain().num_mdps(); ++m) {
      const auto solution = behave(atlas.domain().mdp(m), x);
      EXPECT_EQ(solution.has_value(), atlas.tables().finite_region(atlas.index({m, StateIndex{0}})).contains(w));
      if (!solution) continue;
      ++finite;
      double largest_error = 0.0;
      for (StateIndex s{0}; s.value() < atlas.domain().mdp(m).num_states(); ++s) {
        double best = -std::numeric_limits<double>::infinity();
        for (const auto& vertex : atlas.tables().coverage_set(atlas.index({m, s})))
          best = std::max(best, dot(vertex, x));
        largest_error = std::max(largest_error, std::abs(solution->values[s.value()] - best));
      }
      EXPECT_LE(largest_error, 1e-9);
    }
  }
  return finite;
}

TEST(Atlas, HullMaximumEqualsPlanning) { EXPECT_GT(expect_hull_maximum_is_planned(50), 500u); }

TEST(AtlasSlow, HullMaximumEqualsPlanningForAThousandWeights) {
  EXPECT_GT(expect_hull_maximum_is_planned(1000), 10'000u);
}

// What a demonstration conveys to one belief, by look-up, against planning for
// that belief and comparing paths state by state.
TEST(Atlas, ConveyedConstraintsEqualPlanningForEachBelief) {
  const auto& atlas = item_delivery();
  const auto& domain = atlas.domain();
  const auto& robot_weights = domain.weights().integer;
  const std::vector<double> robot(robot_weights.begin(), robot_weights.end());
  RandomStream random{4};
  for (int i = 0; i < 40; ++i) {
    auto w = random_weights(random);
    w.z() = -std::abs(w.z());
    const std::array<double, 3> x{w.x(), w.y(), w.z()};
    const std::array cells{atlas.tables().cells().locate(w)};
    const MdpIndex m{uniform_index(domain.num_mdps(), random)};
    const auto learner = behave_in_favour(domain.mdp(m), x, robot);
    for (StateIndex s{0}; s.value() < domain.mdp(m).num_states(); ++s) {
      const auto start = atlas.index({m, s});
      std::vector<HalfSpace> expected;
      const auto path = atlas.trajectory(start).states;
      for (std::size_t t = 0; learner && t + 1 < path.size(); ++t) {
        const auto loss = atlas.feature_counts(atlas.index({m, path[t]})) - learner->counts[path[t].value()];
        if (!loss.is_zero()) expected.emplace_back(loss);
      }
      std::sort(expected.begin(), expected.end());
      expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
      ASSERT_EQ(atlas.constraints().half_spaces(atlas.tables().conveyed(atlas.start_class(start), cells)), expected);
    }
  }
}

TEST(Atlas, DeviationCountsAreWhatOneStepComparesThePathWith) {
  const auto& atlas = item_delivery();
  for (StartIndex start{0}; start.value() < atlas.num_states(); start = StartIndex{start.value() + 101}) {
    std::vector<HalfSpace> comparisons;
    for (const auto here : atlas.path(start)) {
      const auto& mdp = atlas.domain().mdp(atlas.id(here).mdp);
      for (std::size_t c = 0; c < mdp.choices(atlas.id(here).start).size(); ++c) {
        const auto loss = atlas.feature_counts(here) - atlas.deviation_counts(here, c);
        if (!loss.is_zero()) comparisons.emplace_back(loss);
      }
    }
    ASSERT_EQ(atlas.constraints().half_spaces(atlas.one_step(start)), minimal_set(comparisons));
  }
  EXPECT_THROW(static_cast<void>(atlas.deviation_counts(StartIndex{0}, 99)), std::invalid_argument);
}

TEST(Atlas, ClassRowsEqualTheDemonstrationsOwn) {
  const auto& atlas = item_delivery();
  RandomStream random{5};
  std::vector<PolicyCellIndex> cells;
  for (int i = 0; i < 8; ++i) {
    auto w = random_weights(random);
    w.z() = -std::abs(w.z());
    cells.push_back(atlas.tables().cells().locate(w));
  }
  const auto rows = atlas.tables().conveyed_by_class(cells);
  const auto words = atlas.words_per_set();
  for (StartIndex start{0}; start.value() < atlas.num_states(); start = StartIndex{start.value() + 7}) {
    const auto row = std::span{rows}.subspan(atlas.start_class(start).value() * words, words);
    ASSERT_EQ(ConstraintSet{row}, atlas.tables().conveyed(atlas.start_class(start), cells));
  }
}

// Somebody who differs from the robot in nothing but c answers a test of c differently.
TEST(Atlas, TestsDiscriminateTheirConstraint) {
  const auto& atlas = item_delivery();
  std::size_t tested = 0;
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    for (const auto start : atlas.tests_for(c)) {
      ASSERT_TRUE(atlas.one_step(start).contains(c));
      auto others = atlas.tables().robot_cell_facets(start);
      ASSERT_TRUE(others.contains(c));
      std::vector<HalfSpace> sides = atlas.constraints().half_spaces(others);
      const auto flip = std::find(sides.begin(), sides.end(), atlas.constraints()[c]);
      ASSERT_NE(flip, sides.end());
      *flip = flip->opposite();
      for (const auto& facet : atlas.tables().finite_region(start).facets()) sides.push_back(facet);
      const auto beyond = Cone::intersection(sides);
      ASSERT_TRUE(beyond.has_value());
      ++tested;
    }
  }
  EXPECT_GT(tested, 100u);
}

TEST(Atlas, NextToTheRobotsWeightsEverybodyAnswersLikeTheRobot) {
  const auto& atlas = item_delivery();
  const auto cell = atlas.tables().cells().locate(atlas.domain().weights().unit);
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    ASSERT_EQ(atlas.tables().answer(start, cell), atlas.feature_counts(start));
  }
}

TEST(PolicyCells, WeightsOfOneCellChooseAlikeAndOthersDiffer) {
  const auto& atlas = item_delivery();
  // Rows of choices are pairwise distinct: a cell is a maximal set of weights that choose alike.
  std::vector<std::vector<PolicyCells::Choice>> rows;
  for (std::size_t cell = 0; cell < atlas.tables().cells().size(); ++cell) {
    auto& row = rows.emplace_back();
    for (std::size_t h = 0; h < atlas.tables().num_hulls(); ++h)
      row.push_back(atlas.tables().cells().choice(PolicyCellIndex{cell}, HullIndex{h}));
  }
  std::sort(rows.begin(), rows.end());
  EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end());
}

}  // namespace
}  // namespace kith
