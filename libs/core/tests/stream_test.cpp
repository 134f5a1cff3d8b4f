#include "kith/core/stream.hpp"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <type_traits>

namespace kith {
namespace {

static_assert(std::uniform_random_bit_generator<RandomStream>);
static_assert(!std::is_convertible_v<std::uint64_t, RandomStream>);

constexpr std::uint64_t kAllOnes = 0xFFFFFFFFFFFFFFFFull;

std::array<std::uint32_t, 4> block(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
  const auto out = r123::Philox4x32{}({{c[0], c[1], c[2], c[3]}}, {{k[0], k[1]}});
  return {out.v[0], out.v[1], out.v[2], out.v[3]};
}

// The known answers for Philox4x32-10 that are published with Random123.
TEST(Philox, GivesThePublishedKnownAnswers) {
  EXPECT_EQ(block({0, 0, 0, 0}, {0, 0}), (std::array{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}));
  EXPECT_EQ(block({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}));
  EXPECT_EQ(block({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u}));
}

TEST(RandomStream, DrawsTheBlocksOfItsKeyFromCounterZeroOn) {
  RandomStream stream{0};  // the first known answer
  for (const std::uint32_t expected : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u})
    EXPECT_EQ(stream(), expected);
  for (const std::uint32_t expected : block({1, 0, 0, 0}, {0, 0})) EXPECT_EQ(stream(), expected);
}

TEST(RandomStream, SplitsIntoTheBlockBehindItsTag) {
  // The second known answer: key and counter all ones.
  EXPECT_EQ(RandomStream{kAllOnes}.split(kAllOnes).address(), 0x41c83b0e408f276dull);
}

TEST(RandomStream, SplitIgnoresHowManyNumbersTheParentDrew) {
  const RandomStream fresh{42};
  RandomStream used{42};
  for (int i = 0; i < 1001; ++i) used();
  EXPECT_EQ(fresh.address(), used.address());
  RandomStream a = fresh.split(7), b = used.split(7);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(a(), b());
}

TEST(RandomStream, ReplaysFromACopy) {
  RandomStream stream{5};
  for (int i = 0; i < 7; ++i) stream();
  RandomStream copy = stream;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(stream(), copy());
}

TEST(RandomStream, GivesDifferentAddressesToDifferentPaths) {
  std::set<std::uint64_t> addresses;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const RandomStream root{seed};
    addresses.insert(root.address());
    for (std::uint64_t i = 0; i < 30; ++i) {
      addresses.insert(root.split(i).address());
      for (std::uint64_t j = 0; j < 30; ++j) addresses.insert(root.split(i).split(j).address());
    }
  }
  // A coincidence would have probability 9310^2 / 2^65 = 2e-12.
  EXPECT_EQ(addresses.size(), 10u * (1 + 30 + 900));
  EXPECT_NE(RandomStream{1}.split(2).split(3).address(), RandomStream{1}.split(3).split(2).address());
}

TEST(RandomStream, SplitsByNameAsByTheNamesTag) {
  EXPECT_EQ(RandomStream{1}.split("noise").address(), RandomStream{1}.split(stream_tag("noise")).address());
  // FNV-1a of "", "a" and "foobar", from the test vectors of its authors.
  static_assert(stream_tag("") == 0xcbf29ce484222325ull);
  static_assert(stream_tag("a") == 0xaf63dc4c8601ec8cull);
  static_assert(stream_tag("foobar") == 0x85944171f73967e8ull);
}

// Siblings and parent: the number of equal bits of two independent streams is
// binomial; 5 standard deviations.
TEST(RandomStream, IsUncorrelatedWithItsChildrenAndNeighbours) {
  const auto equal_bits = [](RandomStream a, RandomStream b) {
    int equal = 0;
    for (int i = 0; i < 10000; ++i) equal += 32 - std::popcount(a() ^ b());
    return equal;
  };
  const double mean = 160000.0;
  const double bound = 5.0 * std::sqrt(320000.0 / 4.0);
  const RandomStream root{9};
  EXPECT_NEAR(equal_bits(root, root.split(std::uint64_t{0})), mean, bound);
  EXPECT_NEAR(equal_bits(root.split(1), root.split(2)), mean, bound);
  EXPECT_NEAR(equal_bits(RandomStream{1}, RandomStream{2}), mean, bound);
}

}  // namespace
}  // namespace kith
