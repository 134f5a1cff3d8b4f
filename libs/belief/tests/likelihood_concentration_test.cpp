// The concentration of HalfSpaceLikelihood against series in 50 digits, which share nothing with its quadrature.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;

// int_0^1 exp(-kappa t) (1 - t^2)^((d - 3) / 2) dt, the mass of a half of the sphere.
//
// Small kappa, of either sign: sum over k of (-kappa)^k / k! B((k + 1) / 2, (d - 1) / 2) / 2, where
// B(a + 1, b) = B(a, b) a / (a + b). The terms are at most about exp(kappa), so 50 digits lose 26 of them at 60.
Real by_power_series(const Real& kappa, int d) {
  const Real b = Real{d - 1} / 2;
  Real even = boost::math::tgamma(Real{1} / 2) * boost::math::tgamma(b) / boost::math::tgamma(b + Real{1} / 2);
  Real odd = 1 / b;  // B(1, b)
  Real factor = 1, sum = 0;
  for (int k = 0; k < 400 && (k < 4 || abs(factor) > abs(sum) * Real{1e-30}); ++k) {
    Real& beta = k % 2 == 0 ? even : odd;
    sum += factor * beta / 2;
    const Real a = Real{k + 1} / 2;
    beta *= a / (a + b);
    factor *= -kappa / (k + 1);
  }
  return sum;
}

// Large kappa: the binomial series of (1 - t^2)^nu, integrated term by term to infinity (Watson's lemma). Terms fall
// until about 2 j = kappa, where they are as small as exp(-kappa).
Real by_asymptotic_series(const Real& kappa, int d) {
  const Real nu = Real{d - 3} / 2;
  Real term = 1 / kappa, sum = 0;
  for (int j = 0; j < 25; ++j) {
    sum += term;
    term *= -(nu - j) / (j + 1) * (2 * j + 1) * (2 * j + 2) / (kappa * kappa);
  }
  return sum;
}

Real half_mass(const Real& kappa, int d) {
  return kappa < 60 ? by_power_series(kappa, d) : by_asymptotic_series(kappa, d);
}

// What the far half has, relative to the near half as the form says.
Real odds_at(const Real& kappa, int d, LikelihoodForm form) {
  const Real near = form == LikelihoodForm::kContinuous ? half_mass(0, d) : by_power_series(-kappa, d);
  return half_mass(kappa, d) / near;
}

std::vector<double> abilities() {
  std::vector<double> all{0.5 + 1e-12, 0.5 + 1e-9, 0.5001,   0.501,    0.51,     0.6,      0.703,
                          0.75,        0.751,      0.9,      0.95,     0.98,     0.99,     0.999,
                          1.0 - 1e-4,  1.0 - 2e-5, 1 - 1e-5, 1 - 1e-6, 1 - 1e-7, 1 - 1e-8, 1.0 - 1e-9};
  RandomStream random{4};
  for (int i = 0; i < 5; ++i) all.push_back(0.5 + 0.5 * uniform01(random));
  for (int i = 0; i < 5; ++i) all.push_back(1.0 - std::pow(10.0, -9.0 * uniform01(random)) / 2.0);
  return all;
}

TEST(HalfSpaceLikelihood, ConcentrationIsRightToTwelveDigitsForEverybodyWhoIsNotCertain) {
  for (const auto form : {LikelihoodForm::kContinuous, LikelihoodForm::kDiscontinuous}) {
    for (int d = 2; d <= 8; ++d) {
      for (const double ability : abilities()) {
        const HalfSpaceLikelihood likelihood{ability, form, static_cast<std::size_t>(d)};
        const Real kappa = likelihood.concentration();
        const Real odds = (1 - Real{ability}) / ability;
        // The odds fall as kappa rises, so those asked for are those of a kappa between these two.
        EXPECT_GT(odds_at(kappa * (1 - Real{1e-12}), d, form), odds) << d << ' ' << ability;
        EXPECT_LT(odds_at(kappa * (1 + Real{1e-12}), d, form), odds) << d << ' ' << ability;
        EXPECT_LE(likelihood.log_far(), 0.0);
        EXPECT_TRUE(std::isfinite(likelihood.log_far())) << d << ' ' << ability;
      }
    }
  }
}

// Whoever is nearly certain keeps what fits, and moves to it if hardly anything does; nobody ends without a belief.
TEST(ParticleBelief, OfPeopleWhoAreNearlyCertainStaysABeliefInEveryDimension) {
  for (const auto form : {LikelihoodForm::kContinuous, LikelihoodForm::kDiscontinuous}) {
    for (std::size_t d = 2; d <= 8; ++d) {
      for (const double ability : {0.95, 1.0 - 1e-4, 1.0 - 5e-6, 1.0 - 1e-9}) {
        IntegerVector last(d), narrow(d);
        last[d - 1] = -1;
        Cone prior{d};
        ASSERT_TRUE(prior.clip(HalfSpace{last}));
        narrow[0] = 1;
        narrow[d - 1] = 20;  // nearly against the prior
        ParticleBelief belief{prior, {.particles = 200}};
        const HalfSpaceLikelihood likelihood{ability, form, d};
        for (std::uint64_t t = 0; t < 4; ++t)
          belief.observe(std::vector{HalfSpace{narrow}}, likelihood, RandomStream{7}.split(t));
        double sum = 0.0;
        for (const double weight : belief.weights()) {
          ASSERT_TRUE(weight >= 0.0 && weight <= 1.0) << d << ' ' << ability;
          sum += weight;
        }
        EXPECT_NEAR(sum, 1.0, 1e-12) << d << ' ' << ability;
        // Within the prior, what satisfies the half-space is a fortieth; an ability of .95 makes it likelier by 19.
        EXPECT_GT(belief.mass_in(std::vector{HalfSpace{narrow}}), 0.2) << d << ' ' << ability;
      }
    }
  }
}

}  // namespace
}  // namespace kith
