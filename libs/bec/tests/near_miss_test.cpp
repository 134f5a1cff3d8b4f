#include "kith/bec/near_miss.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kith {
namespace {

TEST(NearMiss, AnOctantIsMissedBehindTheMiddleOfEachEdge) {
  const std::vector<HalfSpace> octant{HalfSpace{{1, 0, 0}}, HalfSpace{{0, 1, 0}}, HalfSpace{{0, 0, 1}}};
  const auto region = Cone::intersection(octant).value();
  const auto people = near_misses(region, octant, 1.0);
  ASSERT_EQ(people.size(), 3u);
  // The middle of the edge x = 0 is (0, 1, 1) / sqrt(2), and the centre is 1 / sqrt(3) inside.
  const Direction expected = Direction{{-1.0 / std::sqrt(3.0), std::sqrt(0.5), std::sqrt(0.5)}}.normalized();
  EXPECT_LT((people[0] - expected).norm(), 1e-12);
}

TEST(NearMiss, MissesOneFacetAlone) {
  for (const std::vector<HalfSpace>& facets :
       {std::vector<HalfSpace>{HalfSpace{IntegerVector{1, 2}}, HalfSpace{IntegerVector{-1, 3}}},
        std::vector<HalfSpace>{HalfSpace{IntegerVector{1, 0, 0, -2}}, HalfSpace{IntegerVector{0, 1, 0, -1}},
                               HalfSpace{IntegerVector{0, 0, 1, 0}}, HalfSpace{IntegerVector{-1, 0, 0, 5}}}}) {
    const auto people = near_misses(Cone::intersection(facets).value(), facets, 0.1);
    for (std::size_t i = 0; i < facets.size(); ++i) {
      EXPECT_NEAR(people[i].norm(), 1.0, 1e-12);
      for (std::size_t k = 0; k < facets.size(); ++k) EXPECT_EQ(facets[k].contains(people[i]), k != i) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace kith
