// Beliefs on the sphere of other than three dimensions.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include "kith/belief/consistency.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/belief/team_belief.hpp"
#include "kith/core/distributions.hpp"
#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

// The last weight is negative.
Cone lower_half(std::size_t d) {
  IntegerVector normal(d);
  normal[d - 1] = -1;
  Cone cone{d};
  EXPECT_TRUE(cone.clip(HalfSpace{normal}));
  return cone;
}

HalfSpace some_half_space(std::size_t d, std::size_t first, std::int64_t a, std::int64_t b) {
  IntegerVector normal(d);
  normal[first] = a;
  normal[d - 1] = b;
  return HalfSpace{normal};
}

class InDimensions : public ::testing::TestWithParam<std::size_t> {};

// The mass on the near side is the ability, and all mass is 1: by integrating the density over t = u . x, whose own
// density on the sphere is proportional to (1 - t^2)^((d - 3) / 2).
TEST_P(InDimensions, TheAbilityIsTheMassOnTheNearSide) {
  const std::size_t d = GetParam();
  for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
    for (const double ability : {0.55, 0.703, 0.809, 0.95}) {
      const HalfSpaceLikelihood likelihood{ability, form, d};
      double near = 0.0;
      double far = 0.0;
      double all = 0.0;
      constexpr int kSteps = 20'000;
      for (int i = 0; i < kSteps; ++i) {
        const double u = ((static_cast<double>(i) + 0.5) / kSteps - 0.5) * std::numbers::pi;
        const double area = std::pow(std::cos(u), static_cast<double>(d) - 2.0);
        all += area;
        (u >= 0.0 ? near : far) += area * likelihood.density(std::sin(u));
      }
      const double sphere = sphere_area(d);
      EXPECT_NEAR(near / all * sphere, ability, 1e-6);
      EXPECT_NEAR(far / all * sphere, 1.0 - ability, 1e-6);
    }
  }
}

TEST_P(InDimensions, OneThatKnowsNothingLearnsNothing) {
  const HalfSpaceLikelihood likelihood{0.5, LikelihoodForm::kDiscontinuous, GetParam()};
  EXPECT_EQ(likelihood.concentration(), 0.0);
  EXPECT_EQ(likelihood.log_relative(-0.7), 0.0);
  EXPECT_TRUE((HalfSpaceLikelihood{1.0, LikelihoodForm::kDiscontinuous, GetParam()}).is_hard());
}

TEST_P(InDimensions, AnUpdateIsTheProductOfDensities) {
  const std::size_t d = GetParam();
  ParticleBelief belief{lower_half(d), {.particles = 400, .resample_below = 0.0}};
  ASSERT_EQ(belief.dimension(), d);
  const HalfSpaceLikelihood likelihood{0.8, LikelihoodForm::kDiscontinuous, d};
  const std::vector<HalfSpace> list{some_half_space(d, 0, -1, 2), some_half_space(d, 0, 1, -4)};
  belief.observe(list, likelihood, RandomStream{1});
  std::vector<double> expected;
  double sum = 0.0;
  double inside = 0.0;
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const auto point = belief.point(i);
    double product = 1.0;
    bool in_all = true;
    for (const auto& h : list) {
      product *= likelihood.density(h.margin(point));
      in_all = in_all && h.contains(point);
    }
    expected.push_back(product);
    sum += product;
    inside += in_all ? product : 0.0;
  }
  for (std::size_t i = 0; i < belief.size(); ++i) EXPECT_NEAR(belief.weights()[i], expected[i] / sum, 1e-14);
  EXPECT_NEAR(belief.mass_in(list), inside / sum, 1e-12);
}

TEST_P(InDimensions, ResampledPointsStayInThePriorAndOnTheSphere) {
  const std::size_t d = GetParam();
  const Cone prior = lower_half(d);
  ParticleBelief belief{prior, {.particles = 500, .process_noise = 0.5}};
  const HalfSpaceLikelihood likelihood{0.9, LikelihoodForm::kDiscontinuous, d};
  const double before = belief.spread();
  for (std::uint64_t t = 0; t < 12; ++t) {
    belief.observe(std::vector{some_half_space(d, 0, -1, 1), some_half_space(d, 0, 1, -4)}, likelihood,
                   RandomStream{2}.split(t));
  }
  belief.diffuse(0.05, RandomStream{3});
  EXPECT_GT(belief.num_resamplings(), 0u);
  EXPECT_LT(belief.spread(), before);
  std::set<double> first;
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const auto point = belief.point(i);
    EXPECT_NEAR(point.norm(), 1.0, 1e-12);
    EXPECT_TRUE(prior.contains(point));
    first.insert(point[0]);
  }
  EXPECT_EQ(first.size(), belief.size());
}

// Far from the boundary: mean square angle (d - 1) h^2, five standard errors.
TEST_P(InDimensions, NoiseHasItsSizeInEveryDirection) {
  const std::size_t d = GetParam();
  constexpr std::size_t kPoints = 4000;
  constexpr double kAngle = 0.02;
  ParticleBelief belief{Cone{d}, {.particles = kPoints}};
  const ParticleBelief start = belief;
  belief.diffuse(kAngle, RandomStream{4});
  double square = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * std::asin(0.5 * (belief.point(i) - start.point(i)).norm());
    square += angle * angle;
  }
  const double axes = static_cast<double>(d) - 1.0;
  const double expected = axes * kAngle * kAngle;
  EXPECT_NEAR(square / kPoints, expected, 5.0 * expected * std::sqrt(2.0 / (axes * kPoints)));
}

TEST_P(InDimensions, TheLargestAgreeingMembersAreFound) {
  const std::size_t d = GetParam();
  const HalfSpace less = some_half_space(d, 0, -1, 2);
  const HalfSpace more = some_half_space(d, 0, 1, -2);
  const HalfSpace aside = some_half_space(d, d - 2, -1, 0);
  const std::vector<std::vector<HalfSpace>> lists{{less}, {more}, {less, aside}, {}};
  const auto result = largest_consistent_subsets(lists, lower_half(d));
  EXPECT_EQ(result.subsets, (std::vector<std::vector<std::size_t>>{{0, 2, 3}}));
  // One who contradicts himself keeps what he said last.
  const auto reduced = largest_consistent_subsets(std::vector<std::vector<HalfSpace>>{{less, more}}, lower_half(d));
  EXPECT_EQ(reduced.reduced_lists, (std::vector<std::vector<HalfSpace>>{{more}}));
}

// The search by conflicts is checked against all subsets.
TEST_P(InDimensions, AgreeingMembersAreThoseOfBruteForce) {
  const std::size_t d = GetParam();
  auto random = RandomStream{7}.split(d);
  for (int round = 0; round < 12; ++round) {
    std::vector<std::vector<HalfSpace>> lists(5);
    for (auto& list : lists) {
      IntegerVector normal(d);
      for (std::size_t k = 0; k < d; ++k) normal[k] = static_cast<std::int64_t>(uniform_index(5, random)) - 2;
      if (!normal.is_zero()) list.emplace_back(normal);
      const std::size_t first = static_cast<std::size_t>(round) % (d - 1);
      if (!normal.is_zero() && round % 2 == 0) list.push_back(some_half_space(d, first, 1, -round % 3));
    }
    const Cone prior = lower_half(d);
    const auto result = largest_consistent_subsets(lists, prior);
    std::size_t most = 0;
    std::vector<std::vector<std::size_t>> best;
    for (unsigned bits = 0; bits < 32; ++bits) {
      Cone cone = prior;
      std::vector<std::size_t> members;
      bool agree = true;
      for (std::size_t i = 0; i < lists.size(); ++i) {
        if ((bits >> i & 1u) == 0) continue;
        members.push_back(i);
        agree = agree && cone.clip(result.reduced_lists[i]);
      }
      if (!agree || members.size() < most) continue;
      if (members.size() > most) best.clear();
      most = members.size();
      best.push_back(members);
    }
    std::sort(best.begin(), best.end());
    EXPECT_EQ(result.subsets, best);
  }
}

TEST_P(InDimensions, ATeamIsUpdatedWhole) {
  const std::size_t d = GetParam();
  TeamBelief::Options options;
  options.filter.particles = 300;
  options.likelihood = HalfSpaceLikelihood{0.8, LikelihoodForm::kDiscontinuous, d};
  TeamBelief team{lower_half(d), options, {RandomStream{1}, RandomStream{2}}, RandomStream{3}};
  const HalfSpace less = some_half_space(d, 0, -1, 2);
  team.observe_demonstrations(std::vector{less}, 1);
  const auto excluded = team.observe_responses(std::vector<std::vector<HalfSpace>>{{less}, {less.opposite()}}, 1);
  EXPECT_EQ(excluded.size(), 1u);
  EXPECT_GT(team.member(0).mass_in(std::vector{less}), team.member(1).mass_in(std::vector{less}));
}

INSTANTIATE_TEST_SUITE_P(All, InDimensions, ::testing::Values(2, 4, 5, 6, 7, 8),
                         [](const auto& dimension) { return "d" + std::to_string(dimension.param); });

TEST(Likelihood, InSpaceIsTheClosedForm) {
  // The quadrature of other dimensions, between whose shapes space lies, brackets the closed form's concentration.
  const double two = HalfSpaceLikelihood(0.8, LikelihoodForm::kDiscontinuous, 2).concentration();
  const double three = HalfSpaceLikelihood(0.8).concentration();
  const double four = HalfSpaceLikelihood(0.8, LikelihoodForm::kDiscontinuous, 4).concentration();
  EXPECT_NEAR(three, std::log(4.0), 1e-15);
  EXPECT_LT(two, three);
  EXPECT_LT(three, four);
}

TEST(Likelihood, OfAnotherDimensionIsRefused) {
  ParticleBelief belief{Cone{4}, {.particles = 10}};
  EXPECT_THROW(
      belief.observe(std::vector{HalfSpace{IntegerVector{1, 0, 0, 0}}}, HalfSpaceLikelihood{0.8}, RandomStream{1}),
      std::invalid_argument);
  EXPECT_THROW(HalfSpaceLikelihood(0.8, LikelihoodForm::kDiscontinuous, 9), std::invalid_argument);
}

// A digest of the bits of a belief that was resampled and moved, in which one rounding more or less would spread.
std::uint64_t bits_after_updates(std::size_t d) {
  ParticleBelief belief{lower_half(d), {.particles = 250}};
  RandomStream random{d};
  for (int update = 0; update < 40; ++update) {
    const auto axis = uniform_index(d - 1, random);
    const auto entry = static_cast<std::int64_t>(uniform_index(9, random)) - 4;
    const HalfSpaceLikelihood likelihood{0.55 + 0.4 * uniform01(random), LikelihoodForm::kDiscontinuous, d};
    belief.observe(std::vector{some_half_space(d, axis, entry, -5)}, likelihood, random);
  }
  std::uint64_t sum = std::bit_cast<std::uint64_t>(belief.spread());
  for (std::size_t i = 0; i < belief.size(); ++i) {
    for (std::size_t k = 0; k < d; ++k)
      sum = std::rotl(sum, 5) * 0x9E3779B97F4A7C15u ^ std::bit_cast<std::uint64_t>(belief.axis(k)[i]);
  }
  return sum;
}

TEST(Dimensions, HaveTheSameBitsEverywhere) {
  EXPECT_EQ(bits_after_updates(2), 0x19D8F09B473B2CB1u);
  EXPECT_EQ(bits_after_updates(3), 0x6884947CC1C7AE85u);
  EXPECT_EQ(bits_after_updates(4), 0x393044DCDB324BF7u);
  EXPECT_EQ(bits_after_updates(6), 0x7889AA26159A93D2u);
}

}  // namespace
}  // namespace kith
