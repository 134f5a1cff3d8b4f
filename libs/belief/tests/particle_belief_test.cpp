#include "kith/belief/particle_belief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "kith/core/error.hpp"
#include "script.hpp"

namespace kith {
namespace {

using kith::testing::kWeighOnly;
using kith::testing::lower_hemisphere;
using kith::testing::random_list;
using kith::testing::total;

TEST(ParticleBelief, DrawsAsManyAsAskedFrom) {
  ParticleBelief belief{lower_hemisphere(), kWeighOnly};
  RandomStream random{2};
  belief.observe(random_list(3, random), HalfSpaceLikelihood{0.9}, random);
  const auto draws = belief.systematic_draws(8, RandomStream{3});
  std::size_t n = 0;
  for (std::size_t k = 0; k < draws.size(); ++k) {
    n += draws[k].count;
    EXPECT_GT(draws[k].count, 0u);
    if (k > 0) {
      EXPECT_GT(draws[k].index, draws[k - 1].index);
    }
  }
  EXPECT_EQ(n, 8u);
}

// ---- the beginning

TEST(ParticleBelief, BeginsUniformOverThePrior) {
  const ParticleBelief belief{lower_hemisphere(), {.particles = 2000}};
  ASSERT_EQ(belief.size(), 2000u);
  for (std::size_t i = 0; i < belief.size(); ++i) {
    EXPECT_LE(belief.z()[i], 0.0);
    EXPECT_EQ(belief.weights()[i], 1.0 / 2000.0);
  }
  EXPECT_DOUBLE_EQ(belief.effective_sample_size(), 2000.0);
  // A lune of a quarter turn holds a quarter of the hemisphere; the cover is regular to 1 %.
  EXPECT_NEAR(belief.mass_in(std::vector{HalfSpace{{1, 0, 0}}, HalfSpace{{0, 1, 0}}}), 0.25, 0.01);
  EXPECT_EQ(belief.mass_in({}), 1.0);
}

TEST(ParticleBelief, HasTheSameStartFromACover) {
  const FilterOptions options{.particles = 300};
  EXPECT_EQ((ParticleBelief{lower_hemisphere(), options}),
            (ParticleBelief{PriorCover{lower_hemisphere(), 300}, options}));
}

TEST(ParticleBelief, RefusesBadOptions) {
  const Cone prior = lower_hemisphere();
  EXPECT_THROW((ParticleBelief{prior, {.particles = 0}}), std::invalid_argument);
  EXPECT_THROW((ParticleBelief{prior, {.process_noise = -0.1}}), std::invalid_argument);
  EXPECT_THROW((ParticleBelief{prior, {.process_noise = std::nan("")}}), std::invalid_argument);
  EXPECT_THROW((ParticleBelief{prior, {.resample_below = 1.1}}), std::invalid_argument);
  EXPECT_THROW((ParticleBelief{PriorCover{prior, 10}, {.particles = 11}}), std::invalid_argument);
  EXPECT_THROW((PriorCover{prior, 0}), std::invalid_argument);
  ParticleBelief belief{prior, {.particles = 10}};
  EXPECT_THROW(belief.diffuse(-0.1, RandomStream{1}), std::invalid_argument);
}

TEST(ParticleBelief, WorksWithOneParticleOnTheWholeSphere) {
  ParticleBelief belief{Cone{}, {.particles = 1}};
  belief.observe(std::vector{HalfSpace{{1, 0, 0}}}, HalfSpaceLikelihood{0.8}, RandomStream{1});
  EXPECT_EQ(belief.weights()[0], 1.0);
  EXPECT_EQ(belief.effective_sample_size(), 1.0);
  EXPECT_LT(belief.spread(), 1e-15);
}

// ---- weighing

TEST(ParticleBelief, WeighsByTheProductOfLikelihoods) {
  RandomStream random{4};
  for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
    const HalfSpaceLikelihood likelihood{0.8, form};
    ParticleBelief belief{lower_hemisphere(), kWeighOnly};
    std::vector<double> expected(belief.size(), 1.0);
    for (int update = 0; update < 4; ++update) {
      const auto list = random_list(3, random);
      belief.observe(list, likelihood, random);
      double sum = 0.0;
      for (std::size_t i = 0; i < belief.size(); ++i) {
        for (const HalfSpace& h : list) expected[i] *= likelihood.density(h.margin(belief.point(i)));
        sum += expected[i];
      }
      double squares = 0.0;
      for (std::size_t i = 0; i < belief.size(); ++i) {
        ASSERT_NEAR(belief.weights()[i] * sum / expected[i], 1.0, 1e-11);
        squares += expected[i] * expected[i] / (sum * sum);
      }
      EXPECT_NEAR(belief.effective_sample_size() * squares, 1.0, 1e-11);
      EXPECT_NEAR(total(belief.weights()), 1.0, 1e-12);
    }
  }
}

// The fewest so far, whatever is resampled and observed afterwards.
TEST(ParticleBelief, RemembersHowFewPointsSatisfiedWhatWasShown) {
  const HalfSpaceLikelihood likelihood{0.95};
  const std::vector<HalfSpace> quarter{HalfSpace{{1, 0, 0}}, HalfSpace{{0, 1, 0}}};
  const std::vector<HalfSpace> strip{HalfSpace{{1, 0, 0}}, HalfSpace{{-9, 10, 0}}};
  auto options = kWeighOnly;
  options.records_support = true;
  ParticleBelief belief{lower_hemisphere(), options};
  EXPECT_EQ(belief.least_support(), 1000.0);
  const double in_quarter = belief.mass_in(quarter) * 1000.0;
  const double in_strip = belief.mass_in(strip) * 1000.0;
  ASSERT_LT(in_strip, in_quarter);
  belief.observe(quarter, likelihood, RandomStream{1});
  EXPECT_NEAR(belief.least_support(), in_quarter, 1e-6);
  belief.observe({}, likelihood, RandomStream{1});
  EXPECT_NEAR(belief.least_support(), in_quarter, 1e-6);
  belief.observe(strip, likelihood, RandomStream{1});
  const double after_strip = belief.least_support();
  EXPECT_LT(after_strip, in_quarter);
  belief.observe(quarter, likelihood, RandomStream{1});
  EXPECT_EQ(belief.least_support(), after_strip);
  const std::vector<HalfSpace> above{HalfSpace{{0, 0, 1}}};
  belief.observe(above, likelihood, RandomStream{1});
  EXPECT_EQ(belief.least_support(), 0.0);
}

// Above three dimensions, moves that leave the posterior as it is renew the points, unless points do not move.
TEST(ParticleBelief, CountsNoSupportWherePointsAreRenewed) {
  const auto prior = Cone::intersection(std::vector<HalfSpace>{HalfSpace{IntegerVector{0, 0, 0, -1}}}).value();
  const std::vector<HalfSpace> narrow{HalfSpace{IntegerVector{1, 0, 0, 0}}, HalfSpace{IntegerVector{-9, 10, 0, 0}}};
  for (const double noise : {0.1, 0.0}) {
    ParticleBelief belief{prior, {.particles = 500, .process_noise = noise, .records_support = true}};
    belief.observe(narrow, HalfSpaceLikelihood{0.9, LikelihoodForm::kDiscontinuous, 4}, RandomStream{1});
    EXPECT_EQ(belief.least_support() == 500.0, noise > 0.0);
  }
}

// People are told a falsehood again and again, or never, and then the truth. What the first believe in the end depends
// on which of their points happened to fit.
TEST(ParticleBelief, TellsAFalsePriorByItsSupport) {
  const std::vector<HalfSpace> truth{HalfSpace{{-1, 0, 2}}, HalfSpace{{1, 0, -4}}, HalfSpace{{0, 1, 2}},
                                     HalfSpace{{0, -1, -4}}};
  const std::vector<HalfSpace> rubble{truth[0], truth[1]};
  const std::vector<HalfSpace> recharge{truth[2], truth[3]};
  const std::vector<HalfSpace> falsehood{truth[0].opposite(), truth[2].opposite()};
  const PriorCover cover{Cone::intersection(std::vector<HalfSpace>{HalfSpace{{0, 0, -1}}}).value(), 1000};
  std::size_t stuck = 0, impoverished = 0;
  for (std::uint64_t person = 0; person < 120; ++person) {
    for (const bool is_misled : {false, true}) {
      ParticleBelief belief{cover, {.records_support = true}};
      std::uint64_t event = 0;
      const auto show = [&](std::span<const HalfSpace> half_spaces, double ability, int times) {
        for (int i = 0; i < times; ++i) {
          belief.observe(half_spaces, HalfSpaceLikelihood{ability}, RandomStream{person}.split(++event));
        }
      };
      if (is_misled) show(falsehood, 0.9, 6);
      show(rubble, 0.65, 4);
      show(recharge, 0.68, 4);
      show(truth, 0.7, 6);
      const bool knows = belief.mass_in(truth) > 0.6;
      if (!is_misled) {
        EXPECT_TRUE(knows);
        EXPECT_GE(belief.least_support(), kFewParticles);
        continue;
      }
      stuck += knows ? 0u : 1u;
      impoverished += belief.least_support() < kFewParticles ? 1u : 0u;
      if (!knows) {
        EXPECT_LT(belief.least_support(), kFewParticles);
      }
    }
  }
  EXPECT_GE(stuck, 2u);  // about 3 % of 200 were
  EXPECT_GE(impoverished, 60u);
}

TEST(ParticleBelief, DoesNotDependOnTheOrderOfAList) {
  RandomStream random{5};
  for (int round = 0; round < 30; ++round) {
    auto list = random_list(6, random);
    list.push_back(list[1]);
    ParticleBelief forward{lower_hemisphere(), {.particles = 500}};
    ParticleBelief backward = forward;
    forward.observe(list, HalfSpaceLikelihood{0.85}, RandomStream{6});
    std::reverse(list.begin(), list.end());
    backward.observe(list, HalfSpaceLikelihood{0.85}, RandomStream{6});
    EXPECT_EQ(forward, backward);
  }
}

TEST(ParticleBelief, CountsARepeatedHalfSpaceTwice) {
  const HalfSpaceLikelihood likelihood{0.7};
  const HalfSpace h{{1, 2, 0}};
  ParticleBelief twice{lower_hemisphere(), kWeighOnly};
  ParticleBelief once = twice;
  twice.observe(std::vector{h, h}, likelihood, RandomStream{1});
  once.observe(std::vector{h}, likelihood, RandomStream{1});
  once.observe(std::vector{h}, likelihood, RandomStream{1});
  for (std::size_t i = 0; i < twice.size(); ++i) ASSERT_NEAR(twice.weights()[i] / once.weights()[i], 1.0, 1e-12);
}

TEST(ParticleBelief, IsNotChangedByNoEvidence) {
  RandomStream random{7};
  ParticleBelief belief{lower_hemisphere(), {}};
  belief.observe(random_list(2, random), HalfSpaceLikelihood{0.9}, RandomStream{8});
  const ParticleBelief before = belief;
  belief.observe({}, HalfSpaceLikelihood{0.9}, RandomStream{9});
  belief.observe(random_list(4, random), HalfSpaceLikelihood{0.5}, RandomStream{9});
  belief.observe(random_list(4, random), HalfSpaceLikelihood{0.5, LikelihoodForm::kContinuous}, RandomStream{9});
  belief.observe_any({}, HalfSpaceLikelihood{0.9}, RandomStream{9});
  belief.observe_any(std::vector<std::vector<HalfSpace>>{random_list(2, random), {}}, HalfSpaceLikelihood{0.9},
                     RandomStream{9});
  EXPECT_EQ(belief, before);
}

TEST(ParticleBelief, DoesNotUnderflowUnderThreeThousandHalfSpaces) {
  RandomStream random{10};
  ParticleBelief belief{lower_hemisphere(), kWeighOnly};
  std::vector<HalfSpace> against;
  std::vector<HalfSpace> in_favour;
  for (int i = 0; i < 3000; ++i) {
    against.push_back(HalfSpace{{1, static_cast<std::int64_t>(i), 7}});
    in_favour.push_back(against.back().opposite());
  }
  belief.observe(against, HalfSpaceLikelihood{0.95}, random);
  EXPECT_NEAR(total(belief.weights()), 1.0, 1e-12);
  EXPECT_GE(belief.effective_sample_size(), 1.0);
  // Evidence of equal strength brings the other side back, although its weights had vanished in double precision.
  for (int round = 0; round < 2; ++round) belief.observe(in_favour, HalfSpaceLikelihood{0.95}, random);
  EXPECT_NEAR(total(belief.weights()), 1.0, 1e-12);
  EXPECT_GT(belief.mass_in(std::vector{HalfSpace{{0, -1, 0}}}), 0.99);
}

TEST(ParticleBelief, CutsAtAbilityOne) {
  ParticleBelief belief{lower_hemisphere(), {}};
  const std::vector half{HalfSpace{{1, 0, 0}}};
  belief.observe(half, HalfSpaceLikelihood{1.0}, RandomStream{11});
  EXPECT_EQ(belief.mass_in(half), 1.0);
  EXPECT_GT(belief.effective_sample_size(), 450.0);
}

TEST(ParticleBelief, RefusesAHardCutThatLeavesNothingAndStaysAsItWas) {
  for (const auto& [up, down, side] : {std::array{HalfSpace{{0, 0, 1}}, HalfSpace{{0, 0, -1}}, HalfSpace{{1, 0, 0}}},
                                       {HalfSpace{{0, 0, 0, 1}}, HalfSpace{{0, 0, 0, -1}}, HalfSpace{{1, 0, 0, 0}}}}) {
    const auto d = up.dimension();
    ParticleBelief belief{Cone{d}.clipped(down).value(), {}};
    belief.observe(std::vector{side}, HalfSpaceLikelihood{0.8, LikelihoodForm::kDiscontinuous, d}, RandomStream{12});
    const ParticleBelief before = belief;
    const HalfSpaceLikelihood hard{1.0, LikelihoodForm::kDiscontinuous, d};
    const auto kind_of = [](const auto& update) -> std::optional<ErrorKind> {
      try {
        update();
      } catch (const Error& error) {
        return error.kind();
      }
      return std::nullopt;
    };
    const std::vector any{std::vector{up}, std::vector{up, side}};
    EXPECT_EQ(kind_of([&] { belief.observe(any[0], hard, RandomStream{1}); }), ErrorKind::kInfeasible);
    EXPECT_EQ(kind_of([&] { belief.observe_any(any, hard, RandomStream{1}); }), ErrorKind::kInfeasible);
    EXPECT_EQ(belief, before);
  }
}

// ---- alternatives

TEST(ParticleBelief, TakesTheBestAlternative) {
  RandomStream random{13};
  const HalfSpaceLikelihood likelihood{0.8};
  for (int round = 0; round < 20; ++round) {
    const std::vector alternatives{random_list(1, random), random_list(3, random), random_list(2, random)};
    ParticleBelief belief{lower_hemisphere(), kWeighOnly};
    belief.observe_any(alternatives, likelihood, random);
    std::vector<double> expected(belief.size());
    for (std::size_t i = 0; i < belief.size(); ++i) {
      for (const auto& list : alternatives) {
        double product = 1.0;
        for (const HalfSpace& h : list) product *= std::exp(likelihood.log_relative(h.margin(belief.point(i))));
        expected[i] = std::max(expected[i], product);
      }
    }
    const double sum = total(expected);
    for (std::size_t i = 0; i < belief.size(); ++i) ASSERT_NEAR(belief.weights()[i] * sum / expected[i], 1.0, 1e-11);
  }
}

TEST(ParticleBelief, TreatsOneAlternativeOrCopiesOfItAsPlainEvidence) {
  RandomStream random{14};
  for (int round = 0; round < 20; ++round) {
    const auto list = random_list(4, random);
    ParticleBelief plain{lower_hemisphere(), {}};
    ParticleBelief one = plain;
    ParticleBelief copies = plain;
    for (std::uint64_t update = 0; update < 3; ++update) {
      plain.observe(list, HalfSpaceLikelihood{0.8}, RandomStream{update});
      one.observe_any(std::vector<std::vector<HalfSpace>>{list}, HalfSpaceLikelihood{0.8}, RandomStream{update});
      copies.observe_any(std::vector{list, list, list}, HalfSpaceLikelihood{0.8}, RandomStream{update});
    }
    ASSERT_EQ(plain, one);
    ASSERT_EQ(plain, copies);
  }
}

// ---- evidence, mean, spread

TEST(ParticleBelief, HasTheEvidenceOfTheDirectSum) {
  RandomStream random{15};
  for (const double ability : {0.5, 0.7, 0.95, 1.0}) {
    ParticleBelief belief{lower_hemisphere(), kWeighOnly};
    belief.observe(random_list(2, random), HalfSpaceLikelihood{0.7}, random);
    const HalfSpaceLikelihood likelihood{ability};
    for (std::size_t n = 0; n < 4; ++n) {
      auto list = random_list(n, random);
      if (n == 3) list.push_back(list[0]);
      double sum = 0.0;
      for (std::size_t i = 0; i < belief.size(); ++i) {
        double product = belief.weights()[i];
        for (const HalfSpace& h : list) product *= likelihood.density(h.margin(belief.point(i)));
        sum += product;
      }
      if (sum > 0.0) {
        EXPECT_NEAR(belief.log_evidence(list, likelihood), std::log(sum), 1e-11);
      } else {
        EXPECT_EQ(belief.log_evidence(list, likelihood), -std::numeric_limits<double>::infinity());
      }
    }
  }
}

TEST(ParticleBelief, HasAMeanAndASpread) {
  const ParticleBelief belief{lower_hemisphere(), {.particles = 20'000}};
  EXPECT_LT((belief.mean_direction() - Eigen::Vector3d{0, 0, -1}).norm(), 1e-3);
  // On a hemisphere E angle^2 = integral of a^2 sin a over [0, pi/2] = pi - 2.
  EXPECT_NEAR(belief.spread(), std::sqrt(std::numbers::pi - 2.0), 1e-4);
}

}  // namespace
}  // namespace kith
