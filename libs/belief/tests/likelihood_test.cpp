#include "kith/belief/likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <tuple>

#include "golden.hpp"

namespace kith {
namespace {

TEST(HalfSpaceLikelihood, HasThePublishedConcentrations) {
  const std::vector<std::tuple<double, double>> table{{0.7, 0.847298},   {0.703, 0.861625}, {0.8, 1.386294},
                                                      {0.809, 1.443525}, {0.9, 2.197225},   {0.95, 2.944439}};
  for (const auto& [ability, kappa] : table) {
    EXPECT_NEAR(HalfSpaceLikelihood{ability}.concentration(), kappa, 5e-7) << ability;
  }
}

TEST(HalfSpaceLikelihood, HasThePublishedConcentrationsInTheContinuousForm) {
  EXPECT_NEAR((HalfSpaceLikelihood{0.8, LikelihoodForm::kContinuous}.concentration()), 3.92069, 5e-6);
  EXPECT_NEAR((HalfSpaceLikelihood{0.9, LikelihoodForm::kContinuous}.concentration()), 8.99889, 5e-6);
  EXPECT_NEAR((HalfSpaceLikelihood{0.80294, LikelihoodForm::kContinuous}.concentration()), 4.0, 1e-3);
}

// The reference solved for its concentrations numerically, to about 1e-9, and
// is not usable at 0.5, at 1 and, in the continuous form, at 0.975.
TEST(HalfSpaceLikelihood, AgreesWithTheReferenceDensities) {
  KITH_REQUIRE_GOLDEN(path, "pdf.json");
  const auto golden = nlohmann::json::parse(std::ifstream{*path});
  int compared = 0;
  for (const auto& row : golden.at("betas")) {
    const double ability = row.at("beta");
    if (ability < 0.51 || ability > 0.95) continue;
    for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
      const HalfSpaceLikelihood likelihood{ability, form};
      const auto& facts = row.at(form == LikelihoodForm::kDiscontinuous ? "discontinuous" : "continuous");
      for (const auto& [key, value] : facts.items()) {
        const std::string prefix = "obs_prob_dot_";
        if (!key.starts_with(prefix)) continue;
        const double t = std::stod(key.substr(prefix.size()));
        EXPECT_NEAR(likelihood.density(t), value.get<double>(), 1e-9) << ability << ' ' << key;
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 100);
}

class LikelihoodLaws : public ::testing::TestWithParam<std::tuple<double, LikelihoodForm>> {
 protected:
  HalfSpaceLikelihood likelihood_{std::get<0>(GetParam()), std::get<1>(GetParam())};

  // Integral of the density over a zone of the sphere, 2 pi int density(t) dt, by Simpson's rule.
  [[nodiscard]] double mass(double from, double to) const {
    constexpr int n = 20'000;
    const double step = (to - from) / n;
    double sum = likelihood_.density(from) + likelihood_.density(to);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * likelihood_.density(from + i * step);
    return 2.0 * std::numbers::pi * sum * step / 3.0;
  }
};

TEST_P(LikelihoodLaws, AbilityIsTheMassOnTheNearSideAndTheRestIsBeyond) {
  EXPECT_NEAR(mass(0.0, 1.0), likelihood_.ability(), 1e-12);
  EXPECT_NEAR(mass(-1.0, -1e-15), 1.0 - likelihood_.ability(), 1e-11);
}

TEST_P(LikelihoodLaws, DensityIsTheExponentialOfItsLogarithm) {
  for (const double t : {-1.0, -0.3, -1e-9, 0.0, 0.2, 1.0}) {
    EXPECT_NEAR(std::exp(likelihood_.log_density(t)) / likelihood_.density(t), 1.0, 1e-13);
    EXPECT_NEAR(likelihood_.log_relative(t), std::log(likelihood_.density(t) / likelihood_.density(0.0)), 1e-12);
  }
}

TEST_P(LikelihoodLaws, FallsWithTheDistanceFromTheBoundary) {
  EXPECT_LE(likelihood_.log_relative(-1e-12), 0.0);
  EXPECT_LE(likelihood_.density(-0.5), likelihood_.density(-1e-12));
  EXPECT_LE(likelihood_.density(-1.0), likelihood_.density(-0.5));
}

INSTANTIATE_TEST_SUITE_P(Abilities, LikelihoodLaws,
                         ::testing::Combine(::testing::Values(0.5, 0.5 + 1e-9, 0.51, 0.6, 0.703, 0.8, 0.95, 0.99),
                                            ::testing::Values(LikelihoodForm::kDiscontinuous,
                                                              LikelihoodForm::kContinuous)));

TEST(HalfSpaceLikelihood, IsConstantAtAbilityOneHalf) {
  for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
    const HalfSpaceLikelihood likelihood{0.5, form};
    for (const double t : {-1.0, -0.1, 0.0, 1.0}) {
      EXPECT_DOUBLE_EQ(likelihood.density(t), 1.0 / (4.0 * std::numbers::pi));
    }
    EXPECT_EQ(likelihood.log_relative(-1.0), 0.0);
  }
}

TEST(HalfSpaceLikelihood, IsAHardCutAtAbilityOne) {
  for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
    const HalfSpaceLikelihood likelihood{1.0, form};
    EXPECT_TRUE(likelihood.is_hard());
    EXPECT_EQ(likelihood.density(-1e-9), 0.0);
    EXPECT_EQ(likelihood.log_relative(-0.5), -std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(likelihood.density(0.0), 1.0 / (2.0 * std::numbers::pi));
    EXPECT_EQ(likelihood.log_relative(0.0), 0.0);
  }
}

TEST(HalfSpaceLikelihood, IsContinuousOnlyInTheContinuousForm) {
  EXPECT_EQ((HalfSpaceLikelihood{0.8, LikelihoodForm::kContinuous}.log_far()), 0.0);
  // (1 - beta) kappa / (2 beta - 1) at 0.8: 0.2 * 1.386294 / 0.6.
  EXPECT_NEAR(std::exp(HalfSpaceLikelihood{0.8}.log_far()), 0.4620981, 1e-7);
}

TEST(HalfSpaceLikelihood, RefusesAbilitiesThatAreNone) {
  for (const double ability : {0.499, 1.0 + 1e-12, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(HalfSpaceLikelihood{ability}, std::invalid_argument) << ability;
  }
}

TEST(ScaledAbility, MultipliesTheLogOdds) {
  for (const double ability : {0.5, 0.51, 0.703, 0.95, 0.99}) {
    for (const double scale : {0.5, 0.9, 1.0, 2.0}) {
      const double result = scaled_ability(ability, scale);
      EXPECT_NEAR(std::log(result / (1.0 - result)), scale * std::log(ability / (1.0 - ability)), 1e-10);
    }
  }
  EXPECT_EQ(scaled_ability(0.703, 1.0), 0.703);
  EXPECT_EQ(scaled_ability(1.0, 0.9), 1.0);
  EXPECT_EQ(scaled_ability(0.5, 0.9), 0.5);
}

TEST(ScaledAbility, RefusesWhatIsOutOfRange) {
  EXPECT_THROW((void)scaled_ability(0.4, 1.0), std::invalid_argument);
  EXPECT_THROW((void)scaled_ability(0.8, 0.0), std::invalid_argument);
  EXPECT_THROW((void)scaled_ability(0.8, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace kith
