#include "kith/geometry/cover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>

#include "random_systems.hpp"

namespace kith {
namespace {

Cone item_delivery_region() {
  return Cone::intersection(std::vector{HalfSpace{{-1, 0, 2}}, HalfSpace{{0, -1, -4}}, HalfSpace{{1, 1, 0}}}).value();
}

// Share of the columns that `h` contains.
double share_inside(const Eigen::Matrix3Xd& points, const HalfSpace& h) {
  int inside = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) inside += h.contains(Eigen::Vector3d{points.col(i)}) ? 1 : 0;
  return static_cast<double>(inside) / static_cast<double>(points.cols());
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return 2.0 * std::asin((a - b).norm() / 2.0); }

double least_angle(const Eigen::Matrix3Xd& points) {
  double least = 4.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) least = std::min(least, angle(points.col(i), points.col(j)));
  }
  return least;
}

TEST(FibonacciCover, OfTheWholeSphereStandsAtItsFormula) {
  constexpr Eigen::Index n = 50;
  const Eigen::Matrix3Xd points = fibonacci_cover(Cone{}, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / n;
    const double azimuth = std::numbers::pi + 2.0 * std::numbers::pi * static_cast<double>(i) / std::numbers::phi;
    const double radius = std::sqrt(1.0 - z * z);
    EXPECT_NEAR((points.col(i) - Eigen::Vector3d{radius * std::cos(azimuth), radius * std::sin(azimuth), z}).norm(),
                0.0, 1e-13);
  }
}

TEST(FibonacciCover, GivesEveryHemisphereHalfOfItsPoints) {
  RandomStream random{1};
  const Eigen::Matrix3Xd points = fibonacci_cover(Cone{}, 2000);
  for (int i = 0; i < 200; ++i) {
    // A great circle is a belt of about 2 pi / (cell width 0.079) = 79 cells: half of those, of 2000.
    ASSERT_NEAR(share_inside(points, HalfSpace{testing::random_vector(20, random)}), 0.5, 40.0 / 2000.0);
  }
}

TEST(FibonacciCover, OfAConeHasExactlyTheGivenNumberOfPointsAllInside) {
  RandomStream random{2};
  for (const Cone& cone : testing::random_cones(100, 8, random)) {
    for (const std::size_t n : {1u, 2u, 7u, 100u, 500u}) {
      const Eigen::Matrix3Xd points = fibonacci_cover(cone, n);
      ASSERT_EQ(points.cols(), static_cast<Eigen::Index>(n));
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        ASSERT_TRUE(cone.contains(Eigen::Vector3d{points.col(i)}));
        ASSERT_NEAR(points.col(i).norm(), 1.0, 1e-14);
      }
    }
  }
}

// Shares of sub-cones: independent points would miss by up to 3 sqrt(0.25 / 1000)
// = 0.047 over so many cuts; the cover must stay within a standard deviation, 0.016.
TEST(FibonacciCover, OfAConeIsMoreEvenThanIndependentPoints) {
  RandomStream random{3};
  int cuts = 0;
  for (const Cone& cone : testing::random_cones(200, 6, random)) {
    const Eigen::Matrix3Xd points = fibonacci_cover(cone, 1000);
    for (int k = 0; k < 10; ++k) {
      const HalfSpace h{testing::random_vector(6, random)};
      if (!cone.is_cut_by(h)) continue;
      ++cuts;
      ASSERT_NEAR(share_inside(points, h), cone.clipped(h)->solid_angle() / cone.solid_angle(), 0.016);
    }
  }
  EXPECT_GT(cuts, 500);
}

TEST(FibonacciCover, OfARegionKeepsItsPointsApart) {
  const Cone region = item_delivery_region();
  const double cell = std::sqrt(region.solid_angle() / 500.0);
  // Of 500 independent points the closest two are about cell / 500 apart.
  EXPECT_GT(least_angle(fibonacci_cover(region, 500)), 0.3 * cell);
}

TEST(FibonacciCover, RefusesToBeEmpty) { EXPECT_THROW((void)fibonacci_cover(Cone{}, 0), std::invalid_argument); }

// A region whose axes stand in another order is covered by the same points, bit by bit, if they are taken in the same.
TEST(Cover, DoesNotDependOnTheOrderOfAxesThatIsGiven) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, d}) {
      RandomStream random = RandomStream{7}.split(10 * d + n);
      const IntegerVector inside = testing::random_vector(20, random, d);
      std::vector<std::size_t> order(d);
      std::iota(order.begin(), order.end(), std::size_t{0});
      for (std::size_t i = d; i > 1; --i) std::swap(order[i - 1], order[uniform_index(i, random)]);
      Cone region{d}, other{d};
      std::vector<std::size_t> axes(d);  // of the other, in the order in which the first has them
      for (std::size_t k = 0; k < d; ++k) axes[order[k]] = k;
      while (region.facets().size() < n) {
        const auto normal = testing::random_vector(20, random, d);
        if (sign_of_dot(normal, inside) <= 0) continue;
        IntegerVector reordered(d);
        for (std::size_t k = 0; k < d; ++k) reordered[k] = normal[order[k]];
        if (region.implies(HalfSpace{normal})) continue;
        ASSERT_TRUE(region.clip(HalfSpace{normal}) && other.clip(HalfSpace{reordered}));
      }
      std::vector<std::size_t> identity(d);
      std::iota(identity.begin(), identity.end(), std::size_t{0});
      const auto points = cover(region, 100, identity), others = cover(other, 100, axes);
      for (std::size_t k = 0; k < d; ++k)
        ASSERT_EQ(points.row(static_cast<Eigen::Index>(order[k])), others.row(static_cast<Eigen::Index>(k))) << d << n;
    }
  }
}

TEST(KCentres, TakesTheFarthestPointAndTheLowerIndexOfATie) {
  Eigen::Matrix3Xd points(3, 5);
  points << 1, 0, 0, -1, 1,  //
      0, 1, 0, 0, 0,         //
      0, 0, 1, 0, 0;
  EXPECT_EQ(k_centres(points, 4, 0), (std::vector<std::size_t>{0, 3, 1, 2}));
  EXPECT_EQ(k_centres(points, 5, 0), (std::vector<std::size_t>{0, 3, 1, 2, 4}));  // also a duplicate, once
  EXPECT_EQ(k_centres(points, 0, 0), std::vector<std::size_t>{});
  EXPECT_THROW((void)k_centres(points, 6, 0), std::invalid_argument);
  EXPECT_THROW((void)k_centres(points, 2, 5), std::invalid_argument);
}

// Gonzalez's bound: every point lies within the distance at which the next centre would have been taken, and the
// centres are at least that far apart.
TEST(KCentres, CoversWithinTheDistanceOfItsCentres) {
  RandomStream random{5};
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::Matrix3Xd points(3, 60);
    for (Eigen::Index i = 0; i < 60; ++i) points.col(i) = Cone{}.sample(random);
    const auto centres = k_centres(points, 8, uniform_index(60, random));
    ASSERT_EQ(std::set<std::size_t>(centres.begin(), centres.end()).size(), 8u);
    double radius = 0.0, separation = 4.0;
    for (Eigen::Index i = 0; i < 60; ++i) {
      double nearest = 4.0;
      for (const std::size_t c : centres) {
        nearest = std::min(nearest, angle(points.col(i), points.col(static_cast<Eigen::Index>(c))));
      }
      radius = std::max(radius, nearest);
    }
    for (const std::size_t a : centres) {
      for (const std::size_t b : centres) {
        if (a == b) continue;
        separation = std::min(
            separation, angle(points.col(static_cast<Eigen::Index>(a)), points.col(static_cast<Eigen::Index>(b))));
      }
    }
    ASSERT_LE(radius, separation + 1e-12);
  }
}

}  // namespace
}  // namespace kith
