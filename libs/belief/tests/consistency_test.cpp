#include "kith/belief/consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "script.hpp"

namespace kith {
namespace {

using kith::testing::lower_hemisphere;
using kith::testing::random_half_space;
using kith::testing::random_list;
using Lists = std::vector<std::vector<HalfSpace>>;
using Subsets = std::vector<std::vector<std::size_t>>;

// Whether the prior and the lists of the members in `mask` leave a region.
bool feasible(std::uint32_t mask, const Lists& lists, const Cone& prior) {
  std::vector<HalfSpace> all(prior.facets().begin(), prior.facets().end());
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if ((mask >> i & 1u) != 0) all.insert(all.end(), lists[i].begin(), lists[i].end());
  }
  return has_interior(all);
}

Subsets all_largest(const Lists& lists, const Cone& prior) {
  Subsets best;
  for (std::uint32_t mask = 0; mask < (1u << lists.size()); ++mask) {
    std::vector<std::size_t> subset;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      if ((mask >> i & 1u) != 0) subset.push_back(i);
    }
    if (!best.empty() && subset.size() < best.front().size()) continue;
    if (!feasible(mask, lists, prior)) continue;
    if (!best.empty() && subset.size() > best.front().size()) best.clear();
    best.push_back(subset);
  }
  std::sort(best.begin(), best.end());
  return best;
}

// The largest sub-list, of equals the one with the latest half-spaces: masks compare as those lists do.
std::vector<HalfSpace> reduced(const std::vector<HalfSpace>& list, const Cone& prior) {
  Lists single;
  for (const HalfSpace& h : list) single.push_back({h});
  std::uint32_t best = 0;
  const auto size = [](std::uint32_t mask) { return std::popcount(mask); };
  for (std::uint32_t mask = 0; mask < (1u << list.size()); ++mask) {
    if (size(mask) >= size(best) && feasible(mask, single, prior)) best = mask;  // later masks are newer
  }
  std::vector<HalfSpace> kept;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if ((best >> i & 1u) != 0) kept.push_back(list[i]);
  }
  return kept;
}

void expect_oracle(const Lists& lists, const Cone& prior) {
  const auto result = largest_consistent_subsets(lists, prior);
  Lists expected;
  for (const auto& list : lists) expected.push_back(reduced(list, prior));
  ASSERT_EQ(result.reduced_lists, expected);
  ASSERT_EQ(result.subsets, all_largest(expected, prior));
}

TEST(LargestConsistentSubsets, AreThoseOfBruteForce) {
  RandomStream random{1};
  int conflicts = 0;
  for (int round = 0; round < 1500; ++round) {
    Cone prior = round % 3 == 0 ? Cone{} : lower_hemisphere();
    if (round % 3 == 2) prior = prior.clipped(random_half_space(random)).value_or(prior);
    const std::size_t members = 1 + uniform_index(6, random);
    // Entries up to 1 make many planes meet in one ray; up to 1 000 nearly none.
    const std::int64_t limit = std::array<std::int64_t, 4>{1, 2, 5, 1000}[static_cast<std::size_t>(round) % 4];
    Lists lists;
    for (std::size_t i = 0; i < members; ++i) lists.push_back(random_list(uniform_index(5, random), random, limit));
    expect_oracle(lists, prior);
    conflicts += largest_consistent_subsets(lists, prior).subsets.front().size() < members ? 1 : 0;
  }
  EXPECT_GT(conflicts, 300);
}

TEST(LargestConsistentSubsets, HandleBundlesOfPlanesThroughOneLine) {
  RandomStream random{2};
  for (int round = 0; round < 200; ++round) {
    Lists lists;
    for (int i = 0; i < 5; ++i) {
      std::vector<HalfSpace> list;
      for (std::size_t k = 0; k < 1 + uniform_index(3, random); ++k) {
        const auto a = static_cast<std::int64_t>(uniform_index(7, random)) - 3;
        const auto b = static_cast<std::int64_t>(uniform_index(7, random)) - 3;
        list.emplace_back(IntegerVector{a, b == 0 && a == 0 ? 1 : b, a});  // all contain (1, 0, -1)
      }
      lists.push_back(list);
    }
    expect_oracle(lists, round % 2 == 0 ? Cone{} : lower_hemisphere());
  }
}

TEST(LargestConsistentSubsets, KeepEverybodyWhoAgrees) {
  const Lists lists{{HalfSpace{{1, 0, 0}}}, {HalfSpace{{0, 1, 0}}}, {}};
  const auto result = largest_consistent_subsets(lists, lower_hemisphere());
  EXPECT_EQ(result.subsets, (Subsets{{0, 1, 2}}));
  EXPECT_EQ(result.reduced_lists, lists);
}

TEST(LargestConsistentSubsets, ListTiesAndNeverExcludeTheSilent) {
  const Lists lists{{HalfSpace{{1, 0, 0}}}, {}, {HalfSpace{{-1, 0, 0}}}};
  EXPECT_EQ(largest_consistent_subsets(lists, Cone{}).subsets, (Subsets{{0, 1}, {1, 2}}));
}

TEST(LargestConsistentSubsets, CountTouchingRegionsAsConflicts) {
  // The two closed regions share the quarter circle x = 0 only.
  const Lists lists{{HalfSpace{{1, 0, 0}}, HalfSpace{{0, 1, 0}}}, {HalfSpace{{-1, 0, 0}}, HalfSpace{{0, 1, 0}}}};
  EXPECT_EQ(largest_consistent_subsets(lists, lower_hemisphere()).subsets, (Subsets{{0}, {1}}));
}

TEST(LargestConsistentSubsets, KeepTheNewestOfWhatContradictsItself) {
  const HalfSpace east{{1, 0, 0}};
  const HalfSpace west{{-1, 0, 0}};
  const auto result = largest_consistent_subsets(Lists{{east, west}, {west, east}}, lower_hemisphere());
  EXPECT_EQ(result.reduced_lists, (Lists{{west}, {east}}));
  EXPECT_EQ(result.subsets, (Subsets{{0}, {1}}));
}

TEST(LargestConsistentSubsets, EmptyAListThatContradictsThePrior) {
  const auto result =
      largest_consistent_subsets(Lists{{HalfSpace{{0, 0, 1}}}, {HalfSpace{{1, 0, 0}}}}, lower_hemisphere());
  EXPECT_EQ(result.reduced_lists, (Lists{{}, {HalfSpace{{1, 0, 0}}}}));
  EXPECT_EQ(result.subsets, (Subsets{{0, 1}}));
}

TEST(LargestConsistentSubsets, AreOneEmptySetForNobody) {
  EXPECT_EQ(largest_consistent_subsets(Lists{}, lower_hemisphere()).subsets, (Subsets{{}}));
}

TEST(LargestConsistentSubsets, FollowAPermutationOfTheMembers) {
  RandomStream random{3};
  for (int round = 0; round < 100; ++round) {
    Lists lists;
    for (int i = 0; i < 8; ++i) lists.push_back(random_list(3, random));
    Lists reversed(lists.rbegin(), lists.rend());
    const auto forward = largest_consistent_subsets(lists, lower_hemisphere());
    auto backward = largest_consistent_subsets(reversed, lower_hemisphere()).subsets;
    for (auto& subset : backward) {
      for (std::size_t& i : subset) i = 7 - i;
      std::sort(subset.begin(), subset.end());
    }
    std::sort(backward.begin(), backward.end());
    ASSERT_EQ(forward.subsets, backward);
  }
}

// Every result is feasible, and no member can be added to it.
TEST(LargestConsistentSubsets, AreFeasibleAndMaximalForThirtyMembers) {
  RandomStream random{4};
  Lists lists;
  for (int i = 0; i < 30; ++i) lists.push_back(random_list(4, random, 9));
  const Cone prior = lower_hemisphere();
  const auto result = largest_consistent_subsets(lists, prior);
  ASSERT_FALSE(result.subsets.empty());
  for (const auto& subset : result.subsets) {
    std::uint32_t mask = 0;
    for (const std::size_t i : subset) mask |= 1u << i;
    EXPECT_TRUE(feasible(mask, result.reduced_lists, prior));
    for (std::size_t i = 0; i < 30; ++i) {
      if ((mask >> i & 1u) == 0) {
        EXPECT_FALSE(feasible(mask | 1u << i, result.reduced_lists, prior));
      }
    }
  }
}

TEST(LargestConsistentSubsets, StayExactForLargeIntegers) {
  const std::int64_t big = (std::int64_t{1} << 30) - 1;
  // The wedge between these two has an angle of about 2^-60.
  const Lists lists{{HalfSpace{{big, big - 1, 0}}}, {HalfSpace{{-(big - 1), -(big - 2), 0}}}, {HalfSpace{{0, 1, big}}}};
  expect_oracle(lists, Cone{});
  expect_oracle(lists, lower_hemisphere());
}

}  // namespace
}  // namespace kith
