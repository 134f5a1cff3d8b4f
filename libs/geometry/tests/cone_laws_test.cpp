// Laws of cones, over thousands of random members of every kind.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kith/geometry/cone.hpp"
#include "random_systems.hpp"

namespace kith {
namespace {

std::vector<HalfSpace> without(std::vector<HalfSpace> system, std::size_t i) {
  system.erase(system.begin() + static_cast<std::ptrdiff_t>(i));
  return system;
}

TEST(ConeLaws, TheOrderOfClippingDoesNotMatter) {
  RandomStream random{1};
  for (int i = 0; i < 4000; ++i) {
    auto system = testing::random_system(1 + uniform_index(8, random), 4, random);
    const auto reference = Cone::intersection(system);
    for (int k = 0; k < 3; ++k) {
      testing::shuffle(system, random);
      ASSERT_EQ(Cone::intersection(system), reference);
    }
  }
}

TEST(ConeLaws, TheMinimalSetIsASubsetThatImpliesEveryInput) {
  RandomStream random{2};
  for (int i = 0; i < 4000; ++i) {
    const auto system = testing::random_feasible_system(uniform_index(12, random), 6, random);
    const auto cone = Cone::intersection(system).value();
    const auto minimal = cone.minimal_set();
    ASSERT_EQ(Cone::intersection(minimal), cone);
    for (const HalfSpace& h : system) ASSERT_TRUE(cone.implies(h));
    for (const HalfSpace& h : minimal) ASSERT_NE(std::find(system.begin(), system.end(), h), system.end());
  }
}

TEST(ConeLaws, RemovingAnyFacetEnlargesTheCone) {
  RandomStream random{3};
  for (const Cone& cone : testing::random_cones(4000, 6, random)) {
    const auto minimal = cone.minimal_set();
    for (std::size_t k = 0; k < minimal.size(); ++k) {
      const Cone larger = Cone::intersection(without(minimal, k)).value();
      ASSERT_FALSE(larger.implies(minimal[k]));
      ASSERT_TRUE(larger.is_cut_by(minimal[k]));
      ASSERT_LT(cone.solid_angle(), larger.solid_angle());
    }
  }
}

// Which of three things clipping does: nothing, cut, or leave no interior.
TEST(ConeLaws, ImpliesAndIsCutByPredictClipping) {
  RandomStream random{4};
  int cut = 0, implied = 0, emptied = 0;
  for (const Cone& cone : testing::random_cones(2000, 4, random)) {
    for (int k = 0; k < 5; ++k) {
      const HalfSpace h{testing::random_vector(4, random)};
      const auto clipped = cone.clipped(h);
      ASSERT_EQ(clipped == cone, cone.implies(h));
      ASSERT_EQ(!clipped.has_value(), cone.implies(h.opposite()));
      ASSERT_EQ(clipped.has_value() && clipped != cone, cone.is_cut_by(h));
      ++(cone.is_cut_by(h) ? cut : cone.implies(h) ? implied : emptied);
    }
  }
  EXPECT_GT(std::min({cut, implied, emptied}), 500);
}

// Every plane through two generators that has all others on one side carries a
// facet, and there are no other facets. Independent of the clipping order.
std::set<HalfSpace> facets_of_hull(const std::vector<IntegerVector>& generators) {
  std::set<HalfSpace> facets;
  for (const IntegerVector& a : generators) {
    for (const IntegerVector& b : generators) {
      const IntegerVector normal = cross(a, b);
      if (normal.is_zero()) continue;
      const HalfSpace plane{normal};
      const auto on_side = [&](const IntegerVector& g) { return plane.contains(g); };
      if (std::all_of(generators.begin(), generators.end(), on_side)) facets.insert(plane);
    }
  }
  return facets;
}

TEST(ConeLaws, GeneratorsReproduceTheCone) {
  RandomStream random{5};
  for (const Cone& cone : testing::random_cones(3000, 5, random)) {
    const auto generators = cone.generators();
    for (const IntegerVector& g : generators) ASSERT_TRUE(cone.contains(g));
    const auto minimal = cone.minimal_set();
    ASSERT_EQ(facets_of_hull(generators), std::set<HalfSpace>(minimal.begin(), minimal.end()));
  }
}

TEST(ConeLaws, TheInteriorDirectionIsStrictlyInside) {
  RandomStream random{6};
  for (const Cone& cone : testing::random_cones(3000, 8, random)) {
    const IntegerVector w = cone.interior_direction();
    ASSERT_FALSE(w.is_zero());
    for (const HalfSpace& facet : cone.facets()) ASSERT_EQ(sign_of_dot(facet.normal(), w), 1);
  }
}

TEST(ConeLaws, ContainsWhatAllItsHalfSpacesContain) {
  RandomStream random{7};
  for (int i = 0; i < 2000; ++i) {
    const auto system = testing::random_feasible_system(1 + uniform_index(8, random), 5, random);
    const Cone cone = Cone::intersection(system).value();
    for (int k = 0; k < 20; ++k) {
      const IntegerVector w = testing::random_vector(5, random);
      const auto holds = [&](const HalfSpace& h) { return h.contains(w); };
      ASSERT_EQ(cone.contains(w), std::all_of(system.begin(), system.end(), holds));
    }
  }
}

// Entries at the end of the range: 128-bit arithmetic must still decide exactly.
TEST(ConeLaws, HoldForTheLargestNormals) {
  RandomStream random{8};
  const std::int64_t largest = (std::int64_t{1} << 31) - 1;
  for (int i = 0; i < 1000; ++i) {
    auto system = testing::random_feasible_system(3 + uniform_index(6, random), largest, random);
    const Cone cone = Cone::intersection(system).value();
    testing::shuffle(system, random);
    ASSERT_EQ(Cone::intersection(system).value(), cone);
    for (const HalfSpace& h : system) ASSERT_TRUE(cone.implies(h));
    for (const IntegerVector& g : cone.generators()) ASSERT_TRUE(cone.contains(g));
    const HalfSpace& last = system.back();
    const Cone other = Cone::intersection(without(system, system.size() - 1)).value();
    const double behind = other.is_cut_by(last) ? other.clipped(last.opposite())->solid_angle() : 0.0;
    ASSERT_NEAR(cone.solid_angle() + behind, other.solid_angle(), 1e-12);
  }
}

}  // namespace
}  // namespace kith
