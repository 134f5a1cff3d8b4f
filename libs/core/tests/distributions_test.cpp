#include "kith/core/distributions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace kith {
namespace {

constexpr std::size_t kDraws = 200000;

// The largest distance between the empirical and the given distribution function.
double kolmogorov_distance(std::vector<double> draws, const std::function<double(double)>& cdf) {
  std::sort(draws.begin(), draws.end());
  const auto n = static_cast<double>(draws.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double p = cdf(draws[i]);
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, p - rank / n, (rank + 1.0) / n - p});
  }
  return distance;
}

// Dvoretzky-Kiefer-Wolfowitz-Massart: exceeded with probability at most 1e-9.
double distance_bound(std::size_t n) { return std::sqrt(std::log(2.0 / 1e-9) / (2.0 * static_cast<double>(n))); }

template <typename Draw>
std::vector<double> draws_of(Draw draw, std::uint64_t seed) {
  RandomStream random{seed};
  std::vector<double> draws(kDraws);
  for (double& x : draws) x = draw(random);
  return draws;
}

double mean_of(const std::vector<double>& x, int power = 1) {
  double sum = 0.0;
  for (const double value : x) sum += std::pow(value, power);
  return sum / static_cast<double>(x.size());
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

TEST(Uniform01, FollowsItsDistribution) {
  const auto draws = draws_of([](RandomStream& r) { return uniform01(r); }, 1);
  EXPECT_LT(kolmogorov_distance(draws, [](double x) { return x; }), distance_bound(kDraws));
  EXPECT_GE(*std::min_element(draws.begin(), draws.end()), 0.0);
  EXPECT_LT(*std::max_element(draws.begin(), draws.end()), 1.0);
}

TEST(Uniform01, TakesTwoDrawsAndTheir53LeadingBits) {
  RandomStream a{3}, b{3};
  const double x = uniform01(a);
  const std::uint64_t upper = b() >> 5, lower = b() >> 6;
  EXPECT_EQ(x, std::ldexp(static_cast<double>(upper), -27) + std::ldexp(static_cast<double>(lower), -53));
  EXPECT_EQ(a(), b());
}

TEST(UniformIndex, GivesEveryIndexItsShare) {
  RandomStream random{2};
  for (const std::size_t n : {1u, 2u, 6u, 49u}) {
    std::vector<double> count(n);
    for (std::size_t i = 0; i < kDraws; ++i) count.at(uniform_index(n, random)) += 1.0;
    const double p = 1.0 / static_cast<double>(n);
    const double deviation = std::sqrt(kDraws * p * (1.0 - p));
    for (const double c : count) EXPECT_NEAR(c, kDraws * p, 5.0 * deviation) << n;
  }
}

TEST(UniformIndex, IsUnbiasedNearAndBeyondTheWordSize) {
  RandomStream random{3};
  // With 3 * 2^30 an unrejected product would favour every third index by half; 5 deviations of a share of 1/3.
  constexpr std::size_t kAwkward = 3ull << 30;
  double every_third = 0.0;
  for (std::size_t i = 0; i < kDraws; ++i) every_third += uniform_index(kAwkward, random) % 3 == 0 ? 1.0 : 0.0;
  EXPECT_NEAR(every_third, kDraws / 3.0, 5.0 * std::sqrt(kDraws * 2.0 / 9.0));
  constexpr std::size_t kWide = 1ull << 50;
  double sum = 0.0;
  for (std::size_t i = 0; i < kDraws; ++i) {
    const std::size_t index = uniform_index(kWide + 1, random);
    ASSERT_LE(index, kWide);
    sum += static_cast<double>(index) / static_cast<double>(kWide);
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));
}

TEST(UniformIndex, RefusesAnEmptyChoice) {
  RandomStream random{1};
  EXPECT_THROW((void)uniform_index(0, random), std::invalid_argument);
}

TEST(StandardNormal, FollowsItsDistribution) {
  const auto draws = draws_of([](RandomStream& r) { return standard_normal(r); }, 4);
  EXPECT_LT(kolmogorov_distance(draws, normal_cdf), distance_bound(kDraws));
  // Moments of order k have the variance (2k-1)!! - ((k-1)!!)^2 / n.
  EXPECT_NEAR(mean_of(draws, 1), 0.0, 5.0 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(mean_of(draws, 2), 1.0, 5.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(mean_of(draws, 4), 3.0, 5.0 * std::sqrt(96.0 / kDraws));
}

TEST(FillStandardNormal, GivesIndependentNormals) {
  RandomStream random{5};
  std::vector<double> x(kDraws);
  fill_standard_normal(x, random);
  EXPECT_LT(kolmogorov_distance(x, normal_cdf), distance_bound(kDraws));
  // Both branches of a pair share radius and angle: products and products of squares must be uncorrelated.
  double product = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < kDraws; i += 2) {
    product += x[i] * x[i + 1];
    squares += (x[i] * x[i] - 1.0) * (x[i + 1] * x[i + 1] - 1.0);
  }
  const double pairs = kDraws / 2.0;
  EXPECT_NEAR(product / pairs, 0.0, 5.0 / std::sqrt(pairs));
  EXPECT_NEAR(squares / pairs, 0.0, 5.0 * 2.0 / std::sqrt(pairs));
}

TEST(FillStandardNormal, StartsLikeStandardNormalAndHandlesOddSizes) {
  RandomStream a{6}, b{6}, c{6};
  std::vector<double> three(3), four(4);
  fill_standard_normal(three, a);
  fill_standard_normal(four, b);
  EXPECT_TRUE(std::equal(three.begin(), three.end(), four.begin()));
  EXPECT_EQ(three[0], standard_normal(c));
  EXPECT_EQ(three[2], standard_normal(c));
  EXPECT_EQ(a(), b());
}

TEST(HalfNormal, IsTheMagnitudeOfANormal) {
  const double sigma = 0.056;
  const auto draws = draws_of([&](RandomStream& r) { return half_normal(sigma, r); }, 7);
  const auto cdf = [&](double x) { return std::erf(x / (sigma * std::numbers::sqrt2)); };
  EXPECT_LT(kolmogorov_distance(draws, cdf), distance_bound(kDraws));
  const double mean = sigma * std::sqrt(2.0 / std::numbers::pi);
  const double deviation = sigma * std::sqrt(1.0 - 2.0 / std::numbers::pi);
  EXPECT_NEAR(mean_of(draws), mean, 5.0 * deviation / std::sqrt(kDraws));
}

TEST(HalfNormal, IsZeroForZeroSpreadAndRefusesNegativeSpread) {
  RandomStream random{1};
  EXPECT_EQ(half_normal(0.0, random), 0.0);
  EXPECT_THROW((void)half_normal(-1e-9, random), std::invalid_argument);
  EXPECT_THROW((void)half_normal(std::nan(""), random), std::invalid_argument);
  EXPECT_THROW((void)half_normal(HUGE_VAL, random), std::invalid_argument);
}

TEST(Categorical, GivesEveryIndexTheShareOfItsWeight) {
  RandomStream random{8};
  const std::vector<double> weights{0.0, 3.0, 1.0, 0.0, 4.0, 0.0};
  std::vector<double> count(weights.size());
  for (std::size_t i = 0; i < kDraws; ++i) count.at(categorical(weights, random)) += 1.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double p = weights[i] / 8.0;
    EXPECT_NEAR(count[i], kDraws * p, 5.0 * std::sqrt(kDraws * p * (1.0 - p))) << i;  // exactly 0 for weight 0
  }
}

TEST(Categorical, RefusesWeightsWithoutADistribution) {
  RandomStream random{1};
  for (const std::vector<double>& weights :
       {std::vector<double>{}, {0.0, 0.0}, {1.0, -1e-300}, {1.0, std::nan("")}, {1.0, HUGE_VAL}}) {
    EXPECT_THROW((void)categorical(weights, random), std::invalid_argument);
  }
}

}  // namespace
}  // namespace kith
