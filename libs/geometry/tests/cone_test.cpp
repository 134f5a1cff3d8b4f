#include "kith/geometry/cone.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "random_systems.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using testing::half_spaces_with;
using ::testing::IsEmpty;

std::optional<Cone> cone_of(std::initializer_list<IntegerVector> normals) {
  return Cone::intersection(half_spaces_with(normals));
}

std::size_t num_facets(std::initializer_list<IntegerVector> normals) {
  return cone_of(normals).value().facets().size();
}

TEST(Cone, IsTheWholeSphereWithoutHalfSpaces) {
  const Cone sphere;
  EXPECT_THAT(sphere.facets(), IsEmpty());
  EXPECT_EQ(cone_of({}), sphere);
  EXPECT_TRUE(sphere.contains(IntegerVector{-1, 2, 3}));
  EXPECT_FALSE(sphere.implies(HalfSpace{{1, 0, 0}}));
  EXPECT_TRUE(sphere.is_cut_by(HalfSpace{{1, 0, 0}}));
}

TEST(Cone, IgnoresDuplicateAndParallelHalfSpaces) {
  EXPECT_EQ(num_facets({{1, 2, 3}, {1, 2, 3}}), 1u);
  EXPECT_EQ(num_facets({{1, 2, 3}, {2, 4, 6}}), 1u);
  EXPECT_EQ(num_facets({{1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {0, 1, 0}}), 2u);
  EXPECT_EQ(num_facets({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 7}}), 3u);
}

TEST(Cone, HasNoInteriorBetweenOppositeHalfSpaces) {
  EXPECT_EQ(cone_of({{1, 2, 3}, {-1, -2, -3}}), std::nullopt);
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-2, 0, 0}}), std::nullopt);
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}}), std::nullopt);
}

TEST(Cone, HasNoInteriorWhereOnlyARayOrAPlaneIsLeft) {
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}), std::nullopt);              // the line x = y = 0
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, 0}}), std::nullopt);   // the ray along z
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, -1}}), std::nullopt);  // the origin
}

TEST(Cone, ReducesARedundantThirdHalfSpaceToALune) {
  EXPECT_EQ(cone_of({{-1, 0, 0}, {0, 1, 0}, {-1, 1, 0}})->minimal_set(), half_spaces_with({{-1, 0, 0}, {0, 1, 0}}));
}

TEST(Cone, ReplacesASideOfALuneByACoplanarHalfSpace) {
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {-1, 1, 0}})->minimal_set(), half_spaces_with({{-1, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {1, -1, 0}})->minimal_set(), half_spaces_with({{0, 1, 0}, {1, -1, 0}}));
}

TEST(Cone, DropsAHalfSpaceThatTouchesARayOnly) {
  EXPECT_EQ(num_facets({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}), 3u);
  EXPECT_EQ(num_facets({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}), 3u);
}

TEST(Cone, CutsThroughARayIntoTheFacetsLeft) {
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}})->minimal_set(),
            half_spaces_with({{0, 0, 1}, {0, 1, 0}, {1, -1, 0}}));
  EXPECT_EQ(num_facets({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, -1}}), 4u);
}

TEST(Cone, ListsItsFacetsCounterClockwiseSeenFromOutside) {
  RandomStream random{3};
  for (const Cone& cone : testing::random_cones(300, 6, random)) {
    const auto facets = cone.facets();
    if (facets.size() < 3) continue;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const IntegerVector ray = cross(facets[i].normal(), facets[(i + 1) % facets.size()].normal());
      ASSERT_TRUE(cone.contains(ray));
    }
  }
}

TEST(Cone, SortsItsMinimalSet) {
  EXPECT_THAT(cone_of({{1, 1, 0}, {0, -1, -4}, {-1, 0, 2}})->minimal_set(),
              ElementsAre(HalfSpace{{-1, 0, 2}}, HalfSpace{{0, -1, -4}}, HalfSpace{{1, 1, 0}}));
}

TEST(Cone, KeepsItsStateWhenAClipWouldEmptyIt) {
  RandomStream random{4};
  for (Cone cone : testing::random_cones(500, 5, random)) {
    if (cone.facets().empty()) continue;
    const Cone before = cone;
    ASSERT_FALSE(cone.clip(cone.facets().back().opposite()));
    ASSERT_EQ(cone, before);
    ASSERT_TRUE(cone.clip(cone.facets().front()));
    ASSERT_EQ(cone, before);
  }
}

TEST(Cone, ComparesAsASetWhateverTheOrderOfItsHalfSpaces) {
  EXPECT_EQ(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), cone_of({{0, 0, 1}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_NE(cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}));
  EXPECT_NE(cone_of({{1, 0, 0}}), cone_of({{1, 0, 0}, {0, 1, 0}}));
}

TEST(Cone, GeneratesTheOctantByItsAxes) {
  const auto generators = cone_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})->generators();
  EXPECT_EQ(std::set<IntegerVector>(generators.begin(), generators.end()),
            (std::set<IntegerVector>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(IrreducibleConflict, IsEmptyWhereThereIsInterior) {
  EXPECT_THAT(irreducible_conflict({}), IsEmpty());
  EXPECT_THAT(irreducible_conflict(half_spaces_with({{1, 0, 0}, {0, 1, 0}})), IsEmpty());
}

TEST(IrreducibleConflict, NamesTheOppositePairAmongOthersInTheGivenOrder) {
  const auto all = half_spaces_with({{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-3, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(irreducible_conflict(all), half_spaces_with({{1, 0, 0}, {-1, 0, 0}}));
}

TEST(IrreducibleConflict, NeedsEveryOneOfItsMembersAndAtMostFour) {
  RandomStream random{5};
  std::set<std::size_t> sizes;
  for (int i = 0; i < 2000; ++i) {
    const auto system = testing::random_system(3 + uniform_index(7, random), 3, random);
    const auto conflict = irreducible_conflict(system);
    ASSERT_EQ(conflict.empty(), has_interior(system));
    if (conflict.empty()) continue;
    sizes.insert(conflict.size());
    ASSERT_LE(conflict.size(), 4u);
    ASSERT_FALSE(has_interior(conflict));
    for (std::size_t k = 0; k < conflict.size(); ++k) {
      auto rest = conflict;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
      ASSERT_TRUE(has_interior(rest));
    }
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{2, 3, 4}));  // the members above exercise every size that exists
}

}  // namespace
}  // namespace kith
