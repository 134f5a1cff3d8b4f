#include "kith/teaching/credible_level.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

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
