#include "kith/geometry/half_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <unordered_set>

#include "random_systems.hpp"

namespace kith {
namespace {

static_assert(!std::is_default_constructible_v<HalfSpace>);
static_assert(!std::is_convertible_v<IntegerVector, HalfSpace>);

constexpr std::int64_t kLimit = std::int64_t{1} << 31;

TEST(HalfSpace, KeepsItsNormalWithoutCommonDivisor) {
  const HalfSpace h{{-4, 0, 8}};
  EXPECT_EQ(h.normal(), (IntegerVector{-1, 0, 2}));
  EXPECT_EQ(h, (HalfSpace{{-1, 0, 2}}));
  EXPECT_NE(h, (HalfSpace{{1, 0, -2}}));
  EXPECT_DOUBLE_EQ(h.unit_normal().x(), -1.0 / std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(h.unit_normal().z(), 2.0 / std::sqrt(5.0));
}

TEST(HalfSpace, RefusesWhatHasNoBoundaryPlane) {
  EXPECT_THROW((HalfSpace{{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((HalfSpace{{0, 0, 0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((HalfSpace{{1}}), std::invalid_argument);
  EXPECT_THROW(HalfSpace{IntegerVector{}}, std::invalid_argument);
}

TEST(HalfSpace, RefusesEntriesBeyondItsRangeOnlyAfterReducing) {
  EXPECT_THROW((HalfSpace{{kLimit, 1, 0}}), std::invalid_argument);
  EXPECT_THROW((HalfSpace{{1, -kLimit, 0}}), std::invalid_argument);
  EXPECT_NO_THROW((HalfSpace{{kLimit - 1, 1 - kLimit, 1}}));
  EXPECT_EQ((HalfSpace{{8 * kLimit, 0, 16 * kLimit}}), (HalfSpace{{1, 0, 2}}));
}

TEST(HalfSpace, ContainsExactlyOneSideAndItsBoundary) {
  RandomStream random{1};
  for (int i = 0; i < 2000; ++i) {
    const HalfSpace h{testing::random_vector(4, random)};
    const IntegerVector w = testing::random_vector(4, random);
    const bool on_boundary = sign_of_dot(h.normal(), w) == 0;
    ASSERT_EQ(h.contains(w) && h.opposite().contains(w), on_boundary);
    ASSERT_TRUE(h.contains(w) || h.opposite().contains(w));
    ASSERT_EQ(h.opposite().opposite(), h);
  }
}

TEST(HalfSpace, MeasuresTheSineOfTheAngleFromItsBoundary) {
  const HalfSpace h{{0, 3, 4}};
  EXPECT_DOUBLE_EQ(h.margin(Eigen::Vector3d{0.0, 0.6, 0.8}), 1.0);
  EXPECT_DOUBLE_EQ(h.margin(Eigen::Vector3d{1.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(h.margin(Eigen::Vector3d{0.0, 0.0, -1.0}), -0.8);
  EXPECT_TRUE(h.contains(Eigen::Vector3d{1.0, 0.0, 0.0}));
  EXPECT_FALSE(h.contains(Eigen::Vector3d{1.0, 0.0, -1e-300}));
}

TEST(HalfSpace, MarginIsOddAndAgreesWithTheExactSide) {
  RandomStream random{2};
  for (int i = 0; i < 2000; ++i) {
    const HalfSpace h{testing::random_vector(50, random)};
    const IntegerVector w = testing::random_vector(50, random);
    const auto real = Eigen::Vector3d(static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2]));
    ASSERT_EQ(h.opposite().margin(real), -h.margin(real));
    if (sign_of_dot(h.normal(), w) != 0) {
      ASSERT_EQ(h.contains(real), h.contains(w));
    }
  }
}

TEST(HalfSpace, OrdersAndHashesByItsNormal) {
  EXPECT_LT((HalfSpace{{-1, 5, 5}}), (HalfSpace{{0, 0, 1}}));
  const std::unordered_set<HalfSpace> set{HalfSpace{{1, 0, 0}}, HalfSpace{{2, 0, 0}}, HalfSpace{{-1, 0, 0}}};
  EXPECT_EQ(set.size(), 2u);
}

}  // namespace
}  // namespace kith
