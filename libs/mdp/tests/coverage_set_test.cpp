#include "kith/mdp/coverage_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "small_mdps.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using testing::make_mdp;

// Whether n . w > 0 has a common solution, by brute force: in each octant the
// solutions form a pointed cone, which has interior points iff the sum of its
// extreme rays is one; these rays are cross products of two constraints.
bool is_strictly_feasible(const std::vector<IntegerVector>& normals) {
  for (int octant = 0; octant < 8; ++octant) {
    auto all = normals;
    for (std::size_t k = 0; k < 3; ++k) {
      IntegerVector side{0, 0, 0};
      side[k] = ((octant >> k) & 1) != 0 ? 1 : -1;
      all.push_back(side);
    }
    IntegerVector sum{0, 0, 0};
    for (const IntegerVector& a : all) {
      for (const IntegerVector& b : all) {
        const IntegerVector ray = primitive(cross(a, b));
        if (std::ranges::all_of(all, [&](const IntegerVector& n) { return sign_of_dot(n, ray) >= 0; })) sum += ray;
      }
    }
    if (std::ranges::all_of(all, [&](const IntegerVector& n) { return sign_of_dot(n, sum) > 0; })) return true;
  }
  return false;
}

std::vector<IntegerVector> brute_force_hull(std::vector<IntegerVector> vectors, const Cone& region) {
  std::ranges::sort(vectors);
  vectors.erase(std::unique(vectors.begin(), vectors.end()), vectors.end());
  std::vector<IntegerVector> hull;
  for (const IntegerVector& p : vectors) {
    std::vector<IntegerVector> normals;
    for (const HalfSpace& facet : region.facets()) normals.push_back(facet.normal());
    for (const IntegerVector& q : vectors) {
      if (q != p) normals.push_back(p - q);
    }
    if (is_strictly_feasible(normals)) hull.push_back(p);
  }
  return hull;
}

std::optional<Cone> random_region(std::size_t num_half_spaces, RandomStream& random) {
  std::vector<HalfSpace> half_spaces;
  while (half_spaces.size() < num_half_spaces) {
    const IntegerVector normal = testing::random_vector(-4, 4, random);
    if (!normal.is_zero()) half_spaces.emplace_back(normal);
  }
  return Cone::intersection(half_spaces);
}

TEST(UpperHull, EqualsBruteForce) {
  RandomStream random{31};
  int num_dropped_but_undominated = 0;
  for (int i = 0; i < 1500; ++i) {
    SCOPED_TRACE(i);
    const auto region = random_region(uniform_index(6, random), random);
    if (!region) continue;
    std::vector<IntegerVector> vectors;
    const std::size_t n = uniform_index(10, random);
    while (vectors.size() < n) vectors.push_back(testing::random_vector(-4, 4, random));
    const auto hull = upper_hull(vectors, *region);
    ASSERT_EQ(hull, brute_force_hull(vectors, *region));
    for (const IntegerVector& p : vectors) {
      const bool is_dominated = std::ranges::any_of(vectors, [&](const IntegerVector& q) {
        return std::ranges::all_of(region->generators(),
                                   [&](const IntegerVector& g) { return sign_of_dot(q - p, g) >= 0; }) &&
               q != p;
      });
      num_dropped_but_undominated += !is_dominated && !std::ranges::binary_search(hull, p) ? 1 : 0;
    }
  }
  EXPECT_GT(num_dropped_but_undominated, 100);  // the cases that need more than pairwise comparison
}

TEST(UpperHull, OverTheWholeSphereIsTheConvexHull) {
  const std::vector<IntegerVector> vectors{{2, 0, 0}, {0, 2, 0}, {0, 0, 2},   {0, 0, 0},
                                           {1, 1, 0}, {0, 0, 2}, {-1, -1, -1}};
  EXPECT_THAT(upper_hull(vectors, Cone{}), ElementsAre(IntegerVector{-1, -1, -1}, IntegerVector{0, 0, 2},
                                                       IntegerVector{0, 2, 0}, IntegerVector{2, 0, 0}));
}

TEST(UpperHull, OfNothingIsNothing) { EXPECT_TRUE(upper_hull({}, Cone{}).empty()); }

TEST(UpperHull, RefusesOtherDimensions) {
  EXPECT_THROW((void)upper_hull(std::vector{IntegerVector{1, 0}}, Cone{}), std::invalid_argument);
}

ErrorKind kind_of_failure(const Mdp& mdp) {
  try {
    (void)coverage_sets(mdp);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::kUsage;
}

TEST(CoverageSets, HoldBothWaysOfADiamond) {
  const Mdp diamond =
      make_mdp(3, 1, {{0, 0, 1, {1, 0, 1}}, {0, 1, 2, {0, 1, 1}}, {1, 0, 3, {0, 0, 1}}, {2, 0, 3, {0, 0, 1}}});
  const CoverageSets sets = coverage_sets(diamond);
  EXPECT_TRUE(sets.finite_region().facets().empty());
  EXPECT_THAT(sets.vertices(StateIndex{0}), ElementsAre(IntegerVector{0, 1, 2}, IntegerVector{1, 0, 2}));
  EXPECT_THAT(sets.vertices(StateIndex{1}), ElementsAre(IntegerVector{0, 0, 1}));
  EXPECT_EQ(sets.num_vertices(), 4u);
  EXPECT_THROW((void)sets.vertices(StateIndex{3}), std::invalid_argument);
}

TEST(CoverageSets, LeaveOutAWayThatIsNeverBest) {
  // (1,0,1) lies between the other two.
  const Mdp mdp = make_mdp(1, 1, {{0, 0, 1, {0, 0, 1}}, {0, 1, 1, {1, 0, 1}}, {0, 2, 1, {2, 0, 1}}});
  EXPECT_THAT(coverage_sets(mdp).vertices(StateIndex{0}), ElementsAre(IntegerVector{0, 0, 1}, IntegerVector{2, 0, 1}));
}

TEST(CoverageSets, CutTheRegionByACycle) {
  const Mdp mdp = make_mdp(2, 1, {{0, 0, 1, {1, 0, 1}}, {0, 1, 2, {0, 0, 1}}, {1, 0, 0, {0, 1, 1}}});
  const CoverageSets sets = coverage_sets(mdp);
  EXPECT_THAT(sets.finite_region().minimal_set(), ElementsAre(HalfSpace{IntegerVector{-1, -1, -2}}));
  EXPECT_THAT(sets.vertices(StateIndex{1}), ElementsAre(IntegerVector{0, 1, 2}));
}

TEST(CoverageSets, ExistForNoWeightsIfCyclesContradict) {
  EXPECT_EQ(kind_of_failure(make_mdp(3, 1,
                                     {{0, 0, 1, {1, 0, 0}},
                                      {0, 1, 3, {0, 0, 1}},
                                      {1, 0, 0, {0, 0, 0}},
                                      {1, 1, 2, {-1, 0, 0}},
                                      {2, 0, 1, {0, 0, 0}}})),
            ErrorKind::kInfeasible);
}

TEST(CoverageSets, ExistForNoWeightsIfTheFeaturesOfACycleCancel) {
  EXPECT_EQ(kind_of_failure(make_mdp(2, 1, {{0, 0, 1, {1, 0, 1}}, {0, 1, 2, {0, 0, 1}}, {1, 0, 0, {-1, 0, -1}}})),
            ErrorKind::kInfeasible);
}

TEST(CoverageSets, ExistForNoWeightsIfAStateIsStranded) {
  EXPECT_EQ(kind_of_failure(make_mdp(2, 1, {{0, 0, 2, {1, 0, 1}}, {0, 1, 1, {1, 0, 1}}})), ErrorKind::kInfeasible);
}

TEST(CoverageSets, RefuseOtherProcesses) {
  EXPECT_THROW((void)coverage_sets(make_mdp(1, 1, {{0, 0, 1, {0.5, 0, 1}}})), std::invalid_argument);
  EXPECT_THROW((void)coverage_sets(make_mdp(1, 1, {{0, 0, 1, {1, 0, 1}}}, 0.9)), std::invalid_argument);
  EXPECT_THROW((void)coverage_sets(make_mdp(1, 1, {{0, 0, 1, {0, 1}}})), std::invalid_argument);
  EXPECT_THROW((void)coverage_sets(make_mdp(1, 1, {{0, 0, 1, {0, 0, 0x1p30}}})), std::invalid_argument);
}

// Laws of coverage sets over random processes of at most six states.
class CoverageSetLaws : public ::testing::Test {
 protected:
  template <typename Check>
  void for_each_solvable(const Check& check) {
    for (int i = 0; i < 1000; ++i) {
      SCOPED_TRACE(i);
      const Mdp mdp = testing::random_mdp(6, random_);
      try {
        check(mdp, coverage_sets(mdp));
        ++num_checked_;
      } catch (const Error&) {
      }
    }
    EXPECT_GT(num_checked_, 100);
  }

  // Integer weights in the interior: positive combinations of what spans the region and of an inner direction.
  IntegerVector random_inside(const Cone& region) {
    IntegerVector w{0, 0, 0};
    const auto add = [&](const IntegerVector& v, std::int64_t times) {
      for (std::size_t k = 0; k < 3; ++k) w[k] += times * v[k];
    };
    for (const IntegerVector& g : region.generators()) add(g, testing::uniform_integer(0, 20, random_));
    add(region.interior_direction(), testing::uniform_integer(1, 5, random_));
    return w;
  }

  RandomStream random_{32};
  int num_checked_ = 0;
};

TEST_F(CoverageSetLaws, TheFiniteRegionIsWhereAllCyclesLose) {
  int num_feasible = 0;
  int num_infeasible = 0;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(i);
    const Mdp mdp = testing::random_mdp(5, random_);
    std::vector<HalfSpace> losing;
    bool has_free_cycle = false;
    for (const IntegerVector& c : testing::all_cycles(mdp)) {
      if (c.is_zero()) has_free_cycle = true;
      if (!c.is_zero()) losing.emplace_back(-c);
    }
    const auto expected = Cone::intersection(losing);
    const bool stranded = mdp.by_distance().size() < mdp.num_states();
    if (stranded || has_free_cycle || !expected) {
      EXPECT_EQ(kind_of_failure(mdp), ErrorKind::kInfeasible);
      num_infeasible += stranded ? 0 : 1;
    } else {
      EXPECT_EQ(coverage_sets(mdp).finite_region(), *expected);
      ++num_feasible;
    }
  }
  EXPECT_GT(num_feasible, 100);
  EXPECT_GT(num_infeasible, 5);
}

TEST_F(CoverageSetLaws, TheHullMaximumIsTheOptimalValueInside) {
  for_each_solvable([&](const Mdp& mdp, const CoverageSets& sets) {
    for (int i = 0; i < 10; ++i) {
      const IntegerVector w = random_inside(sets.finite_region());
      const auto exact = plan_exactly(mdp, w).solution;
      ASSERT_TRUE(exact);
      const auto real = behave(mdp, testing::to_real(w));
      ASSERT_TRUE(real);
      for (std::size_t s = 0; s < mdp.num_states(); ++s) {
        const auto vertices = sets.vertices(StateIndex{s});
        const auto by_reward = [&](const IntegerVector& mu) { return static_cast<std::int64_t>(dot(w, mu)); };
        const std::int64_t best = by_reward(*std::ranges::max_element(vertices, {}, by_reward));
        EXPECT_EQ(best, exact->values[s]);
        EXPECT_EQ(static_cast<double>(best), real->values[s]);
      }
    }
  });
}

TEST_F(CoverageSetLaws, SomeCycleGainsStrictlyOutsideAndCostsNothingOnTheBoundary) {
  int num_outside = 0;
  int num_boundary = 0;
  for_each_solvable([&](const Mdp& mdp, const CoverageSets& sets) {
    const Cone& region = sets.finite_region();
    for (int i = 0; i < 10; ++i) {
      const IntegerVector w = testing::random_vector(-9, 9, random_);
      if (region.contains(w)) continue;
      EXPECT_EQ(plan_exactly(mdp, w).failure, PlanFailure::kPositiveCycle);
      ++num_outside;
    }
    if (region.facets().empty()) return;
    for (const IntegerVector& g : region.generators()) {
      const bool on_boundary = std::ranges::any_of(
          region.facets(), [&](const HalfSpace& facet) { return sign_of_dot(facet.normal(), g) == 0; });
      if (!on_boundary) continue;
      EXPECT_EQ(plan_exactly(mdp, g).failure, PlanFailure::kZeroCycle);
      ++num_boundary;
    }
  });
  EXPECT_GT(num_outside, 500);
  EXPECT_GT(num_boundary, 200);
}

TEST_F(CoverageSetLaws, EveryVertexIsTheOnlyOptimumSomewhereInside) {
  std::size_t most = 0;
  for_each_solvable([&](const Mdp& mdp, const CoverageSets& sets) {
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const auto vertices = sets.vertices(StateIndex{s});
      ASSERT_TRUE(std::ranges::is_sorted(vertices));
      most = std::max(most, vertices.size());
      for (const IntegerVector& p : vertices) {
        std::optional<Cone> cell = sets.finite_region();
        for (const IntegerVector& q : vertices) {
          if (q != p) cell = cell->clipped(HalfSpace{p - q});
          ASSERT_TRUE(cell);
        }
        const auto solution = plan_exactly(mdp, cell->interior_direction()).solution;
        ASSERT_TRUE(solution);
        EXPECT_EQ(solution->feature_counts[s], p);
      }
    }
  });
  EXPECT_GE(most, 4u);
}

TEST_F(CoverageSetLaws, TheyAreTheHullsOfAllSimplePaths) {
  for_each_solvable([&](const Mdp& mdp, const CoverageSets& sets) {
    std::size_t num_vertices = 0;
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      const auto vertices = sets.vertices(StateIndex{s});
      EXPECT_EQ(std::vector(vertices.begin(), vertices.end()),
                upper_hull(testing::all_paths(mdp, s), sets.finite_region()));
      num_vertices += vertices.size();
    }
    EXPECT_EQ(sets.num_vertices(), num_vertices);
  });
}

}  // namespace
}  // namespace kith
