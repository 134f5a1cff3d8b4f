#include "kith/teaching/credible_level.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

TEST(CredibleLevel, OfOneHypothesisIsItsBetaDistribution) {
  // Beta(1, 1) is uniform.
  const std::vector<WeightedShare> one{{.weight = 3.0, .share = 0.5}};
  const auto level = credible_level(one, {.enough = 0.75, .coverage = 0.8, .precision = 2.0});
  EXPECT_NEAR(level.mean, 0.5, 1e-12);
  EXPECT_NEAR(level.low, 0.1, 1e-8);
  EXPECT_NEAR(level.high, 0.9, 1e-8);
  EXPECT_NEAR(level.probability, 0.25, 1e-12);
}

TEST(CredibleLevel, IsWideWhereHypothesesDisagree) {
  const std::vector<WeightedShare> agreed{{.weight = 1.0, .share = 0.6}};
  const std::vector<WeightedShare> disputed{{.weight = 0.4, .share = 0.0}, {.weight = 0.6, .share = 1.0}};
  const auto sure = credible_level(agreed);
  const auto unsure = credible_level(disputed);
  EXPECT_NEAR(sure.mean, unsure.mean, 1e-12);
  EXPECT_LT(sure.high - sure.low, 0.25);
  EXPECT_GT(unsure.high - unsure.low, 0.95);
  EXPECT_NEAR(unsure.probability, 0.6, 1e-6);
}

// Random mixtures, among them some of few and very different hypotheses.
TEST(CredibleLevel, ContainsItsMean) {
  RandomStream random{3};
  for (int i = 0; i < 2000; ++i) {
    std::vector<WeightedShare> shares(1 + uniform_index(6, random));
    for (auto& share : shares) {
      share.weight = std::exp(-12.0 * uniform01(random));
      share.share = uniform01(random) < 0.5 ? static_cast<double>(uniform_index(2, random)) : uniform01(random);
    }
    const double coverage = 0.05 + 0.9 * uniform01(random);
    const auto level = credible_level(shares, {.coverage = coverage, .precision = 1.0 + 200.0 * uniform01(random)});
    EXPECT_LE(0.0, level.low);
    EXPECT_LE(level.low, level.mean);
    EXPECT_LE(level.mean, level.high);
    EXPECT_LE(level.high, 1.0);
    EXPECT_GE(level.probability, 0.0);
    EXPECT_LE(level.probability, 1.0);
  }
}

TEST(CredibleLevel, ByAnswersIsThatOfAUniformPrior) {
  const auto nothing = level_by_answers(0, 0);
  EXPECT_NEAR(nothing.mean, 0.5, 1e-12);
  EXPECT_NEAR(nothing.probability, 0.2, 1e-12);
  const auto all = level_by_answers(14, 14);  // 1 - 0.8^15
  EXPECT_NEAR(all.probability, 1.0 - std::pow(0.8, 15), 1e-12);
  for (std::size_t n = 5; n <= 40; ++n) EXPECT_LT(level_by_answers(0, n).probability, 1e-4);
  EXPECT_THROW(static_cast<void>(level_by_answers(2, 1)), std::invalid_argument);
}

TEST(CredibleLevel, RefusesWhatIsOutOfRange) {
  const std::vector<WeightedShare> one{{.weight = 1.0, .share = 0.5}};
  const std::vector<WeightedShare> none{{.weight = 0.0, .share = 0.5}};
  EXPECT_THROW(static_cast<void>(credible_level(none)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(credible_level(one, {.enough = 1.0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(credible_level(one, {.coverage = 0.0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(credible_level(one, {.precision = 0.0})), std::invalid_argument);
}

}  // namespace
}  // namespace kith
