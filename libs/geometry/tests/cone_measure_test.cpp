#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kith/geometry/cone.hpp"
#include "random_systems.hpp"

namespace kith {
namespace {

using testing::half_spaces_with;
using testing::worst_margin;

double area_of(std::initializer_list<IntegerVector> normals) { return solid_angle(half_spaces_with(normals)); }

TEST(SolidAngle, IsKnownForSphereHemisphereLuneAndOctant) {
  EXPECT_DOUBLE_EQ(area_of({}), 4.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(area_of({{3, -1, 2}}), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(area_of({{1, 0, 0}, {0, 1, 0}}), std::numbers::pi);
  EXPECT_DOUBLE_EQ(area_of({{1, 0, 0}, {-1, 1, 0}}), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(area_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(area_of({{1, -1, 0}, {0, 1, -1}, {0, 0, 1}}), std::numbers::pi / 12.0);  // x >= y >= z >= 0
  EXPECT_DOUBLE_EQ(area_of({{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}}),
                   2.0 * std::numbers::pi / 3.0);  // a face of a cube
  EXPECT_EQ(area_of({{1, 0, 0}, {-1, 0, 0}}), 0.0);
}

// Areas that exact arithmetic gives for the built-in domains, rounded to the digits shown.
TEST(SolidAngle, MatchesTheTableOfKnownRegions) {
  EXPECT_NEAR(area_of({{0, 0, -1}, {-1, 0, 2}}), 0.927295, 5e-7);
  EXPECT_NEAR(area_of({{0, 0, -1}, {1, 0, -4}}), 5.793228, 5e-7);
  EXPECT_NEAR(area_of({{0, 0, -1}, {-1, 0, 2}, {1, 0, -4}}), 0.437338, 5e-7);
  EXPECT_NEAR(area_of({{0, 0, -1}, {0, 1, 2}, {0, -1, -4}}), 0.437338, 5e-7);
  EXPECT_NEAR(area_of({{0, 0, -1}, {-1, 0, 2}, {1, 0, -4}, {0, 1, 2}, {0, -1, -4}}), 0.052189, 5e-7);
  EXPECT_NEAR(area_of({{-1, 0, 2}, {0, -1, -4}, {1, 1, 0}}), 0.0260947, 5e-8);
  EXPECT_NEAR(area_of({{0, 0, -1}, {-1, 0, 6}, {1, 0, -8}}), 0.081587, 5e-7);
  EXPECT_NEAR(area_of({{0, 0, -1}, {0, -1, 4}, {0, 1, -6}}), 0.159660, 5e-7);
  EXPECT_NEAR(area_of({{-1, 0, 6}, {0, 1, -6}, {1, -1, -2}}), 0.00322492, 5e-9);
  EXPECT_NEAR(area_of({{-9, 1, 1}, {5, 2, -2}, {6, -4, 1}, {8, 1, -2}}), 0.000351122, 5e-10);
  EXPECT_NEAR(area_of({{-9, 1, 1}, {-4, 5, -2}, {5, 2, -2}, {6, -4, 1}}), 0.000281747, 5e-10);
}

// The bound is relative to the larger cone's area, wherever that is below one steradian.
TEST(SolidAngle, IsAdditiveUnderEveryCut) {
  RandomStream random{1};
  int cuts = 0;
  for (const std::int64_t largest : {3, 20, 1000, 1000000}) {
    for (const Cone& cone : testing::random_cones(2000, largest, random)) {
      const HalfSpace h{testing::random_vector(largest, random)};
      if (!cone.is_cut_by(h)) continue;
      ++cuts;
      const double both = cone.clipped(h)->solid_angle() + cone.clipped(h.opposite())->solid_angle();
      ASSERT_NEAR(both, cone.solid_angle(), 1e-12 * std::min(1.0, cone.solid_angle()) + 1e-14) << largest;
    }
  }
  EXPECT_GT(cuts, 3000);
}

// A tiny triangle around (0, 0, 1) is flat: its area tends to that of the plane
// triangle with corners (0,0), (1,0), (0,1), all divided by m.
TEST(SolidAngle, KeepsItsDigitsForTinyRegions) {
  for (const std::int64_t m : {1000ll, 1000000ll, 1000000000ll}) {
    const auto scale = static_cast<double>(m);
    const double flat = 0.5 / scale / scale;
    EXPECT_NEAR(area_of({{1, 0, 0}, {0, 1, 0}, {-m, -m, 1}}) / flat, 1.0, 1.0 / scale / scale + 1e-14) << m;
  }
}

TEST(SolidAngle, StaysWithinTheSphereAndFallsWhenClipping) {
  RandomStream random{2};
  for (const Cone& cone : testing::random_cones(2000, 6, random)) {
    ASSERT_GT(cone.solid_angle(), 0.0);
    ASSERT_LE(cone.solid_angle(), 4.0 * std::numbers::pi);
    const auto clipped = cone.clipped(HalfSpace{testing::random_vector(6, random)});
    if (clipped) {
      ASSERT_LE(clipped->solid_angle(), cone.solid_angle());
    }
  }
}

// Counts draws of `cone` on either side of random cuts; the share of each side
// must be that of its area, within 5 standard deviations of the binomial count.
void expect_uniform(const Cone& cone, const std::vector<HalfSpace>& cuts, std::uint64_t seed) {
  constexpr int kDraws = 5000;
  RandomStream random{seed};
  std::vector<int> counts(cuts.size());
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d w = cone.sample(random);
    ASSERT_NEAR(w.norm(), 1.0, 1e-14);
    ASSERT_GE(worst_margin(cone, w), -1e-15);
    for (std::size_t k = 0; k < cuts.size(); ++k) counts[k] += cuts[k].contains(w) ? 1 : 0;
  }
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    const double share = cone.clipped(cuts[k])->solid_angle() / cone.solid_angle();
    EXPECT_NEAR(counts[k], kDraws * share, 5.0 * std::sqrt(kDraws * share * (1.0 - share)))
        << to_string(cuts[k].normal());
  }
}

// Half-spaces through a random direction inside, so that they really cut.
std::vector<HalfSpace> cuts_through(const Cone& cone, std::size_t count, RandomStream& random) {
  const auto generators = cone.generators();
  std::vector<HalfSpace> cuts;
  while (cuts.size() < count) {
    IntegerVector w(3);
    for (const IntegerVector& g : generators)
      for (auto times = uniform_index(6, random); times > 0; --times) w += g;
    const IntegerVector normal = cross(w, testing::random_vector(5, random));
    if (!normal.is_zero() && cone.is_cut_by(HalfSpace{normal})) cuts.emplace_back(normal);
  }
  return cuts;
}

TEST(ConeSample, IsUniformOnConesOfEveryKind) {
  RandomStream random{3};
  std::uint64_t seed = 100;
  for (const Cone& cone : testing::random_cones(36, 6, random)) {
    expect_uniform(cone, cuts_through(cone, 6, random), seed++);
  }
}

TEST(ConeSample, IsUniformOnTinyAndThinCones) {
  RandomStream random{4};
  const std::int64_t m = 30000;
  for (const auto& system :
       {half_spaces_with({{-9, 1, 1}, {5, 2, -2}, {6, -4, 1}, {8, 1, -2}}),
        half_spaces_with({{1, 0, 0}, {0, 1, 0}, {-m, -m, 1}}),                // 1 / m wide and long
        half_spaces_with({{1, 0, 0}, {-m, 1, 0}, {0, 1, 5}, {0, 1, -5}}),     // 1 / m wide, not short
        half_spaces_with({{1, 0, 0}, {-m, 1, 0}}),                            // a thin lune
        half_spaces_with({{1, m, 0}, {-1, m, 0}, {0, 1, 1}, {0, 1, -1}})}) {  // nearly a hemisphere wide
    const Cone cone = Cone::intersection(system).value();
    expect_uniform(cone, cuts_through(cone, 6, random), 7);
  }
}

TEST(ConeSample, DependsOnTheStreamAlone) {
  const Cone cone = Cone::intersection(half_spaces_with({{-1, 0, 2}, {0, -1, -4}, {1, 1, 0}})).value();
  RandomStream a{5}, b{5};
  for (int i = 0; i < 10; ++i) ASSERT_EQ(cone.sample(a), cone.sample(b));
  for (int i = 0; i < 4; ++i) b();
  EXPECT_NE(cone.sample(a), cone.sample(b));
}

// Of a fine grid of the square, the share that lands on one side of a cut must
// be that side's share of the area.
TEST(EqualAreaPoint, MapsEqualAreasToEqualAreas) {
  RandomStream random{6};
  constexpr int kSide = 100;
  for (const Cone& cone : testing::random_cones(18, 6, random)) {
    for (const HalfSpace& cut : cuts_through(cone, 2, random)) {
      int inside = 0;
      for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
          inside += cut.contains(cone.equal_area_point((i + 0.5) / kSide, (j + 0.5) / kSide)) ? 1 : 0;
        }
      }
      // Only cells that the cut crosses can be miscounted, each by less than one; a
      // line crosses at most 2 kSide of them, a curve that turns twice 6 kSide: half at fault on average.
      const double share = cone.clipped(cut)->solid_angle() / cone.solid_angle();
      ASSERT_NEAR(inside / (1.0 * kSide * kSide), share, 3.0 / kSide);
    }
  }
}

}  // namespace
}  // namespace kith
