#include "kith/core/integer_vector.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>
#include <type_traits>
#include <unordered_set>
#include <vector>

namespace kith {
namespace {

static_assert(!std::is_convertible_v<std::size_t, IntegerVector>);
static_assert(!std::is_convertible_v<IntegerVector, bool>);

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();

// Small entries on purpose, so that zeros, common divisors and equal vectors occur.
IntegerVector random_vector(std::size_t dimension, std::mt19937& engine) {
  IntegerVector v(dimension);
  for (std::size_t k = 0; k < dimension; ++k) v[k] = static_cast<std::int64_t>(engine() % 13) - 6;
  return v;
}

TEST(IntegerVector, StartsAsTheZeroVectorOfItsDimension) {
  const IntegerVector v(4);
  EXPECT_EQ(v.size(), 4u);
  EXPECT_TRUE(v.is_zero());
  EXPECT_EQ(v, (IntegerVector{0, 0, 0, 0}));
  EXPECT_NE(v, IntegerVector(3));
}

TEST(IntegerVector, RejectsMoreThanEightEntries) {
  EXPECT_NO_THROW(IntegerVector(8));
  EXPECT_THROW(IntegerVector(9), std::invalid_argument);
  EXPECT_THROW((IntegerVector{1, 2, 3, 4, 5, 6, 7, 8, 9}), std::invalid_argument);
  const std::vector<std::int64_t> nine(9, 1);
  EXPECT_THROW(IntegerVector{std::span{nine}}, std::invalid_argument);
}

TEST(IntegerVector, FormsAGroupUnderAddition) {
  std::mt19937 engine{1};
  for (int i = 0; i < 500; ++i) {
    const std::size_t d = 1 + engine() % 8;
    const IntegerVector a = random_vector(d, engine), b = random_vector(d, engine), c = random_vector(d, engine);
    ASSERT_EQ((a + b) + c, a + (b + c));
    ASSERT_EQ(a + b, b + a);
    ASSERT_EQ(a - b, a + (-b));
    ASSERT_TRUE((a - a).is_zero());
  }
}

TEST(IntegerVector, RefusesToAddAcrossDimensions) {
  EXPECT_THROW((void)(IntegerVector{1, 2} + IntegerVector{1, 2, 3}), std::logic_error);
  EXPECT_THROW((void)dot(IntegerVector{1, 2}, IntegerVector{1, 2, 3}), std::logic_error);
  const std::array x{1.0};
  EXPECT_THROW((void)dot(IntegerVector{1, 2}, x), std::logic_error);
}

TEST(IntegerVector, IsOrderedByDimensionThenLexicographically) {
  EXPECT_LT((IntegerVector{9, 9}), (IntegerVector{0, 0, 0}));
  EXPECT_LT((IntegerVector{-1, 5, 5}), (IntegerVector{0, -5, -5}));
  EXPECT_LT((IntegerVector{1, 2, -4}), (IntegerVector{1, 2, 3}));
}

TEST(IntegerVector, IsTotallyOrderedInStepWithEquality) {
  std::mt19937 engine{2};
  for (int i = 0; i < 2000; ++i) {
    const IntegerVector a = random_vector(2, engine), b = random_vector(2, engine);
    ASSERT_EQ((a < b) + (a == b) + (b < a), 1);
    ASSERT_EQ(std::is_eq(a <=> b), a == b);
    if (a == b) {
      ASSERT_EQ(std::hash<IntegerVector>{}(a), std::hash<IntegerVector>{}(b));
    }
  }
}

TEST(IntegerVector, HashesTheSmallVectorsOfThreeDimensionsApart) {
  std::unordered_set<std::size_t> hashes;
  for (std::int64_t x = -10; x <= 10; ++x) {
    for (std::int64_t y = -10; y <= 10; ++y) {
      for (std::int64_t z = -10; z <= 10; ++z) hashes.insert(std::hash<IntegerVector>{}(IntegerVector{x, y, z}));
    }
  }
  EXPECT_EQ(hashes.size(), 21u * 21u * 21u);
}

TEST(IntegerVector, TakesDotProductsThatLeave64Bits) {
  const std::int64_t big = std::int64_t{1} << 62;
  const IntegerVector a{big, big, 1};
  EXPECT_TRUE(dot(a, a) == (Int128{1} << 125) + 1);
  EXPECT_EQ(sign_of_dot(a, IntegerVector{big, -big, 1}), 1);
  EXPECT_EQ(sign_of_dot(a, IntegerVector{big, -big, 0}), 0);
  EXPECT_EQ(sign_of_dot(a, IntegerVector{big, -big, -1}), -1);
}

TEST(IntegerVector, TakesDotProductsWithRealVectors) {
  const std::array w{-3.0, 3.5, -1.0};
  EXPECT_EQ(dot(IntegerVector{2, 1, 4}, w), -6.5);
}

TEST(Primitive, DividesByTheGreatestCommonDivisorAndKeepsTheDirection) {
  EXPECT_EQ(primitive(IntegerVector{6, -9, 0}), (IntegerVector{2, -3, 0}));
  EXPECT_EQ(primitive(IntegerVector{0, 0, -7}), (IntegerVector{0, 0, -1}));
  EXPECT_EQ(primitive(IntegerVector{0, 0, 0}), (IntegerVector{0, 0, 0}));
  EXPECT_EQ(primitive(IntegerVector{kLowest, 0, 0}), (IntegerVector{-1, 0, 0}));
  EXPECT_EQ(primitive(IntegerVector{kLowest, 2, 0}), (IntegerVector{kLowest / 2, 1, 0}));
}

TEST(Primitive, IsTheSameForAllPositiveMultiples) {
  std::mt19937 engine{3};
  for (int i = 0; i < 1000; ++i) {
    const IntegerVector v = random_vector(3, engine);
    const IntegerVector p = primitive(v);
    ASSERT_EQ(primitive(p), p);
    ASSERT_EQ(primitive(v + v + v), p);
    ASSERT_EQ(primitive(-v), -p);
    if (!v.is_zero()) {
      ASSERT_EQ(sign_of_dot(v, p), 1);
    }
  }
}

TEST(Cross, IsOrthogonalToBothFactorsAndAntisymmetric) {
  EXPECT_EQ(cross(IntegerVector{1, 0, 0}, IntegerVector{0, 1, 0}), (IntegerVector{0, 0, 1}));
  EXPECT_EQ(cross(IntegerVector{1, 2, 3}, IntegerVector{4, 5, 6}), (IntegerVector{-3, 6, -3}));
  std::mt19937 engine{4};
  for (int i = 0; i < 1000; ++i) {
    const IntegerVector a = random_vector(3, engine), b = random_vector(3, engine);
    ASSERT_EQ(sign_of_dot(cross(a, b), a), 0);
    ASSERT_EQ(sign_of_dot(cross(a, b), b), 0);
    ASSERT_EQ(cross(a, b), -cross(b, a));
  }
}

TEST(Cross, IsExactUpToItsRangeAndRefusesToLeaveIt) {
  const std::int64_t m = (std::int64_t{1} << 31) - 1;
  EXPECT_EQ(cross(IntegerVector{m, m, 0}, IntegerVector{-m, m, 0}), (IntegerVector{0, 0, 2 * m * m}));
  const std::int64_t big = std::int64_t{1} << 40;
  EXPECT_THROW((void)cross(IntegerVector{big, 0, 0}, IntegerVector{0, big, 0}), std::overflow_error);
  EXPECT_THROW((void)cross(IntegerVector{1, 0}, IntegerVector{0, 1}), std::invalid_argument);
}

TEST(ToString, WritesEntriesInParentheses) {
  EXPECT_EQ(to_string(IntegerVector{1, 0, -4}), "(1,0,-4)");
  EXPECT_EQ(to_string(IntegerVector{}), "()");
}

}  // namespace
}  // namespace kith
