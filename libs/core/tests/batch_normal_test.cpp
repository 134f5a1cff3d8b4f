#include "kith/core/batch_normal.hpp"

#include <Random123/threefry.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace kith {
namespace {

// The transform written plainly with the standard library.
std::vector<double> plain(std::size_t size, RandomStream random) {
  const std::uint32_t k0 = random();
  const std::uint32_t k1 = random();
  const std::size_t pairs = (size + 1) / 2;
  std::vector<double> out(size);
  for (std::size_t i = 0; i < pairs; ++i) {
    const auto counter = static_cast<std::uint32_t>(i / 256 * 128 + i % 128);
    const std::size_t half = i % 256 / 128;
    const auto word = r123::Threefry4x32_R<20>{}({{counter, 0, 0, 0}}, {{k0, k1, 0, 0}});
    const double u = ((word[2 * half] >> 1) + 0.5) * 0x1.0p-31;
    const std::uint32_t w = word[2 * half + 1];
    const double angle =
        ((w & 0x3FFFFFFFu) + 0.5 - 0x1.0p29) * 0x1.0p-30 * std::numbers::pi / 2 + (w >> 30) * std::numbers::pi / 2;
    const double radius = std::sqrt(-2.0 * std::log(u));
    out[i] = radius * std::cos(angle);
    if (pairs + i < size) out[pairs + i] = radius * std::sin(angle);
  }
  return out;
}

// The first values of all pairs, then the second.
std::vector<double> batch(std::size_t size, RandomStream& random) {
  const NormalPairs normal{random};
  NormalPairs::Block cosine;
  NormalPairs::Block sine;
  const std::size_t pairs = (size + 1) / 2;
  std::vector<double> out(size);
  for (std::size_t i = 0; i < pairs; ++i) {
    const auto place = i % NormalPairs::kBlock;
    if (place == 0) normal.fill(i / NormalPairs::kBlock, cosine, sine);
    out[i] = cosine[place];
    if (pairs + i < size) out[pairs + i] = sine[place];
  }
  return out;
}

TEST(NormalPairs, IsTheBoxMullerTransformToSinglePrecision) {
  for (const std::size_t size : {0u, 1u, 2u, 3u, 511u, 512u, 513u, 1024u, 2001u, 200'000u}) {
    const RandomStream random = RandomStream{11}.split(size);
    RandomStream drawn = random;
    const auto out = batch(size, drawn);
    const auto expected = plain(size, random);
    for (std::size_t i = 0; i < size; ++i) ASSERT_NEAR(out[i], expected[i], 1e-6) << size << ' ' << i;
  }
}

TEST(NormalPairs, DependsOnTheStreamAndAdvancesIt) {
  RandomStream a{3};
  RandomStream b{3};
  const auto first = batch(100, a);
  const auto again = batch(100, b);
  const auto next = batch(100, a);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, next);
}

// n = 2 * 10^6. Standard errors of the first four moments of N(0, 1):
// sqrt(1/n), sqrt(2/n), sqrt(15/n), sqrt(96/n); five of them are the bounds.
TEST(NormalPairs, HasTheMomentsOfAStandardNormal) {
  constexpr std::size_t n = 2'000'000;
  RandomStream random{4};
  auto out = batch(n, random);
  std::vector<double> moment(4, 0.0);
  for (const double x : out) {
    moment[0] += x / n;
    moment[1] += x * x / n;
    moment[2] += x * x * x / n;
    moment[3] += x * x * x * x / n;
  }
  EXPECT_NEAR(moment[0], 0.0, 5.0 * std::sqrt(1.0 / n));
  EXPECT_NEAR(moment[1], 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(moment[2], 0.0, 5.0 * std::sqrt(15.0 / n));
  EXPECT_NEAR(moment[3], 3.0, 5.0 * std::sqrt(96.0 / n));
}

// Kolmogorov-Smirnov: sqrt(n) D exceeds 2.2 with probability 2 exp(-2 * 2.2^2) = 1.3e-4.
TEST(NormalPairs, HasTheNormalDistributionFunction) {
  constexpr std::size_t n = 200'000;
  RandomStream random{5};
  auto out = batch(n, random);
  std::sort(out.begin(), out.end());
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double p = 0.5 * std::erfc(-out[i] / std::numbers::sqrt2);
    worst = std::max({worst, std::abs(p - static_cast<double>(i) / n), std::abs(p - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(worst * std::sqrt(static_cast<double>(n)), 2.2);
}

// The two branches of a pair, and neighbouring pairs, are uncorrelated: 5 / sqrt(n).
TEST(NormalPairs, HasIndependentBranchesAndNeighbours) {
  constexpr std::size_t n = 500'000;
  RandomStream random{6};
  auto out = batch(2 * n, random);
  double branches = 0.0;
  double squares = 0.0;
  double neighbours = 0.0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    branches += out[i] * out[n + i] / n;
    squares += (out[i] * out[i] - 1.0) * (out[n + i] * out[n + i] - 1.0) / (2.0 * n);
    neighbours += out[i] * out[i + 1] / n;
  }
  const double bound = 5.0 / std::sqrt(static_cast<double>(n));
  EXPECT_LT(std::abs(branches), bound);
  EXPECT_LT(std::abs(squares), bound);
  EXPECT_LT(std::abs(neighbours), bound);
}

// The words are those of Threefry, so every pair of NormalPairs comes from one pair of words.
TEST(WordPairs, AreTheWordsOfThreefry) {
  RandomStream random{7};
  RandomStream same{7};
  const WordPairs words{random};
  const std::uint32_t k0 = same();
  const std::uint32_t k1 = same();
  WordPairs::Block first;
  WordPairs::Block second;
  for (const std::uint64_t block : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1} << 33u}) {
    words.fill(block, first, second);
    for (std::uint64_t i = 0; i < WordPairs::kBlock; ++i) {
      const std::uint64_t counter = block * 128 + i % 128;
      const auto expected = r123::Threefry4x32_R<20>{}(
          {{static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32u), 0, 0}}, {{k0, k1, 0, 0}});
      const std::size_t half = i / 128;
      ASSERT_EQ(first[i], expected[2 * half]) << block << ' ' << i;
      ASSERT_EQ(second[i], expected[2 * half + 1]) << block << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace kith
