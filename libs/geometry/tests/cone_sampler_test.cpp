// Areas against closed forms and against counting, draws and covers against areas.

#include "kith/geometry/cone_sampler.hpp"

#include <gtest/gtest.h>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numbers>

#include "../src/sobol.hpp"
#include "kith/geometry/cloud.hpp"
#include "kith/geometry/cover.hpp"
#include "random_systems.hpp"

namespace kith {
namespace {

using testing::worst_margin;

IntegerVector axis(std::size_t d, std::size_t k) {
  IntegerVector v(d);
  v[k] = 1;
  return v;
}

// One system beside the other, in as many dimensions as both together.
std::vector<HalfSpace> product(std::span<const HalfSpace> first, std::size_t d1, std::span<const HalfSpace> second,
                               std::size_t d2) {
  std::vector<HalfSpace> result;
  const auto add = [&](const HalfSpace& h, std::size_t shift) {
    IntegerVector v(d1 + d2);
    for (std::size_t k = 0; k < h.dimension(); ++k) v[shift + k] = h.normal()[k];
    result.emplace_back(v);
  };
  for (const HalfSpace& h : first) add(h, 0);
  for (const HalfSpace& h : second) add(h, d1);
  return result;
}

Cone cone_of(std::size_t d, std::span<const HalfSpace> half_spaces) {
  Cone cone{d};
  if (!cone.clip(half_spaces)) throw std::logic_error{"no interior"};
  return cone;
}

double share_of(std::size_t d, std::span<const HalfSpace> half_spaces) {
  return cone_of(d, half_spaces).solid_angle() / sphere_area(d);
}

// A claim that holds within three standard errors; closed forms up to rounding.
void expect_area(const SolidAngle& found, double expected, const std::string& what) {
  EXPECT_NEAR(found.value, expected, 3.0 * found.standard_error + 1e-12 * expected) << what;
  EXPECT_LT(found.standard_error, 0.01 * found.value) << what;
}

TEST(SphereArea, IsKnown) {
  EXPECT_DOUBLE_EQ(sphere_area(2), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(sphere_area(3), 4.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(sphere_area(4), 2.0 * std::numbers::pi * std::numbers::pi);
  EXPECT_DOUBLE_EQ(sphere_area(8), std::pow(std::numbers::pi, 4.0) / 3.0);
  EXPECT_THROW((void)sphere_area(0), std::invalid_argument);
}

TEST(SolidAngleInDimensions, IsTheAngleOfAnArcInTwo) {
  EXPECT_DOUBLE_EQ(Cone{2}.solid_angle(), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(share_of(2, std::vector{HalfSpace{{3, -1}}}), 0.5);
  EXPECT_DOUBLE_EQ(share_of(2, std::vector{HalfSpace{{1, 0}}, HalfSpace{{-1, 1}}}), 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(share_of(2, std::vector{HalfSpace{{1, 0}}, HalfSpace{{1, 1}}}), 3.0 / 8.0);
  const auto thin = cone_of(2, std::vector{HalfSpace{{1, 0}}, HalfSpace{{-1000000000, 1}}}).measure();
  EXPECT_NEAR(thin.value / 1e-9, 1.0, 1e-15);
  EXPECT_EQ(thin.standard_error, 0.0);
}

TEST(SolidAngleInDimensions, HalvesWithEachAxis) {
  for (std::size_t d = 2; d <= 8; ++d) {
    Cone cone{d};
    for (std::size_t k = 0; k < d; ++k) {
      ASSERT_TRUE(cone.clip(HalfSpace{axis(d, k)}));
      const SolidAngle area = cone.measure();
      expect_area(area, sphere_area(d) / std::exp2(static_cast<double>(k + 1)),
                  std::to_string(k + 1) + " axes of " + std::to_string(d));
      if (k < 3) {
        EXPECT_EQ(area.standard_error, 0.0);
      }
    }
  }
}

// x_1 >= ... >= x_d: one of d! equal parts; with x_d >= 0 one of 2^d d!.
TEST(SolidAngleInDimensions, IsKnownForOrderedCoordinates) {
  double parts = 2.0;
  for (std::size_t d = 3; d <= 8; ++d) {
    parts *= static_cast<double>(d);
    std::vector<HalfSpace> ordered;
    for (std::size_t k = 0; k + 1 < d; ++k) ordered.emplace_back(axis(d, k) - axis(d, k + 1));
    expect_area(cone_of(d, ordered).measure(), sphere_area(d) / parts, "ordered " + std::to_string(d));
    ordered.emplace_back(axis(d, d - 1));
    expect_area(cone_of(d, ordered).measure(), sphere_area(d) / parts / std::exp2(static_cast<double>(d)),
                "ordered and positive " + std::to_string(d));
  }
}

// The largest coordinate is x_1, in size: one of 2 d equal cones over cubes, whose rays are far apart.
TEST(SolidAngleInDimensions, IsKnownForTheFacesOfACube) {
  for (std::size_t d = 3; d <= 7; ++d) {
    std::vector<HalfSpace> face;
    for (std::size_t k = 1; k < d; ++k) {
      face.emplace_back(axis(d, 0) - axis(d, k));
      face.emplace_back(axis(d, 0) + axis(d, k));
    }
    expect_area(cone_of(d, face).measure(), sphere_area(d) / (2.0 * static_cast<double>(d)),
                "face in " + std::to_string(d));
  }
}

// Shares of the sphere multiply, since a normal vector has independent parts. The
// error over the standard error of 16 estimates has about Student's distribution
// with 15 degrees of freedom: beyond 3 once in 110, mean square 1.15.
TEST(SolidAngleInDimensions, MultipliesOverPerpendicularFactorsWithAnHonestStandardError) {
  RandomStream random{1};
  int estimated = 0, beyond_three = 0;
  double squares = 0.0;
  for (int i = 0; i < 80; ++i) {
    const std::size_t d1 = 2 + uniform_index(2, random);
    const std::size_t d2 = 2 + uniform_index(2, random);
    const auto first = testing::random_feasible_system(1 + uniform_index(6, random), 5, random, d1);
    const auto second = testing::random_feasible_system(1 + uniform_index(6, random), 5, random, d2);
    const SolidAngle area = cone_of(d1 + d2, product(first, d1, second, d2)).measure();
    const double expected = sphere_area(d1 + d2) * share_of(d1, first) * share_of(d2, second);
    if (area.standard_error == 0.0) {
      EXPECT_NEAR(area.value, expected, 1e-12 * expected);
      continue;
    }
    const double z = (area.value - expected) / area.standard_error;
    ++estimated;
    beyond_three += std::abs(z) > 3.0 ? 1 : 0;
    squares += z * z;
    EXPECT_LT(std::abs(z), 6.0) << i;
  }
  EXPECT_GT(estimated, 50);
  EXPECT_LE(beyond_three, 3);
  EXPECT_LT(squares / estimated, 1.6);
}

// A cone in space keeps its share of the sphere when lines are added to it, in closed form.
TEST(SolidAngleInDimensions, AgreesWithSpaceBesideLines) {
  RandomStream random{2};
  for (int i = 0; i < 60; ++i) {
    const std::size_t lines = 1 + uniform_index(5, random);
    const auto system = testing::random_feasible_system(3 + uniform_index(6, random), 6, random);
    const SolidAngle area = cone_of(3 + lines, product(system, 3, {}, lines)).measure();
    EXPECT_EQ(area.standard_error, 0.0);
    EXPECT_NEAR(area.value / sphere_area(3 + lines), share_of(3, system), 1e-12);
  }
}

Direction uniform_direction(std::size_t d, RandomStream& random) {
  Direction w(static_cast<Eigen::Index>(d));
  fill_standard_normal(std::span{w.data(), d}, random);
  return w.normalized();
}

// The share of 100 000 directions of the whole sphere: an integrator that knows neither rays nor simplices.
TEST(SolidAngleInDimensions, AgreesWithCountingDirections) {
  RandomStream random{3};
  constexpr int kDraws = 100000;
  for (std::size_t d = 4; d <= 8; ++d) {
    for (int i = 0; i < 2; ++i) {
      const auto system = testing::random_feasible_system(i == 0 ? d : d / 2 + 4, 4, random, d);
      const Cone cone = cone_of(d, system);
      int count = 0;
      for (int n = 0; n < kDraws; ++n) count += cone.contains(uniform_direction(d, random)) ? 1 : 0;
      const SolidAngle area = cone.measure();
      const double share = area.value / sphere_area(d);
      const double sd = std::hypot(std::sqrt(share * (1.0 - share) / kDraws), area.standard_error / sphere_area(d));
      EXPECT_NEAR(static_cast<double>(count) / kDraws, share, 3.0 * sd) << "d = " << d;
      EXPECT_GT(count, 30);
    }
  }
}

// How often errors exceed one, two and three standard errors of both sides, over cuts of random cones.
TEST(SolidAngleInDimensions, IsAdditiveUnderCutsWithinItsStandardErrors) {
  RandomStream random{4};
  int cuts = 0, beyond_two = 0;
  for (std::size_t d = 4; d <= 7; ++d) {
    for (int i = 0; i < 12; ++i) {
      const Cone cone = cone_of(d, testing::random_feasible_system(d + uniform_index(3, random), 5, random, d));
      const HalfSpace h{testing::random_vector(5, random, d)};
      if (!cone.is_cut_by(h)) continue;
      ++cuts;
      const SolidAngle whole = cone.measure();
      const SolidAngle near = cone.clipped(h)->measure();
      const SolidAngle far = cone.clipped(h.opposite())->measure();
      const double error = std::hypot(whole.standard_error, near.standard_error, far.standard_error);
      const double gap = std::abs(near.value + far.value - whole.value);
      EXPECT_LT(gap, 4.0 * error) << "d = " << d;
      beyond_two += gap > 2.0 * error ? 1 : 0;
    }
  }
  EXPECT_GT(cuts, 30);
  EXPECT_LE(beyond_two, cuts / 8);
}

// x_1, ..., x_(d-1) >= 0 and m times their sum at most x_d: flat where m is large,
// the volume of a simplex with legs of 1 / m.
TEST(SolidAngleInDimensions, KeepsARelativeErrorForTinyCones) {
  for (std::size_t d = 4; d <= 7; ++d) {
    const std::int64_t m = d == 4 ? 100000 : 500;
    std::vector<HalfSpace> system;
    IntegerVector last = axis(d, d - 1);
    for (std::size_t k = 0; k + 1 < d; ++k) {
      system.emplace_back(axis(d, k));
      last[k] = -m;
    }
    system.emplace_back(last);
    const SolidAngle area = cone_of(d, system).measure();
    const double flat = std::pow(static_cast<double>(m), 1.0 - static_cast<double>(d)) / std::tgamma(double(d));
    EXPECT_NEAR(area.value / flat, 1.0, 20.0 / static_cast<double>(m * m) + 1e-9) << d;
  }
}

TEST(SolidAngleInDimensions, HasTheSameBitsForEqualCones) {
  RandomStream random{5};
  for (std::size_t d = 2; d <= 7; ++d) {
    for (int i = 0; i < 4; ++i) {
      auto system = testing::random_feasible_system(1 + uniform_index(d + 3, random), 5, random, d);
      const Cone cone = cone_of(d, system);
      testing::shuffle(system, random);
      const Cone other = cone_of(d, system);
      if (d == 3) continue;
      ASSERT_EQ(cone.measure().value, other.measure().value);
      ASSERT_EQ(ConeSampler{cone}.cover(50), ConeSampler{other}.cover(50));
    }
  }
}

// Half-spaces through the interior, with the share of the area that they leave.
struct Cut {
  HalfSpace half_space;
  double share;
  double error;
};

std::vector<Cut> cuts_of(const Cone& cone, std::size_t count, RandomStream& random) {
  std::vector<Cut> cuts;
  while (cuts.size() < count) {
    const HalfSpace h{testing::random_vector(4, random, cone.dimension())};
    if (!cone.is_cut_by(h)) continue;
    const SolidAngle whole = cone.measure();
    const SolidAngle part = cone.clipped(h)->measure();
    const double share = part.value / whole.value;
    if (share < 0.02 || share > 0.98) continue;
    cuts.push_back({h, share, share * (part.standard_error / part.value + whole.standard_error / whole.value)});
  }
  return cuts;
}

// Whole spheres, cones with lines and pointed ones; pointed ones only for the larger kinds.
Cone cone_of_kind(std::size_t d, std::size_t kind, RandomStream& random) {
  const std::size_t n = kind == 0 ? 0 : kind == 1 ? d / 2 : kind == 2 ? d : d + 3;
  return cone_of(d, testing::random_feasible_system(n, 4, random, d));
}

void expect_uniform_draws(std::span<const std::size_t> dimensions, std::size_t kinds, std::uint64_t seed) {
  RandomStream random{seed};
  constexpr int kDraws = 3000;
  for (const std::size_t d : dimensions) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const Cone cone = cone_of_kind(d, kind, random);
      const auto cuts = cuts_of(cone, 2, random);
      const ConeSampler sampler{cone};
      std::vector<int> counts(cuts.size());
      for (int i = 0; i < kDraws; ++i) {
        const Direction w = sampler.sample(random);
        ASSERT_NEAR(w.norm(), 1.0, 1e-14);
        ASSERT_GE(worst_margin(cone, w), -1e-14);
        for (std::size_t k = 0; k < cuts.size(); ++k) counts[k] += cuts[k].half_space.contains(w) ? 1 : 0;
      }
      for (std::size_t k = 0; k < cuts.size(); ++k) {
        const double sd = std::sqrt(cuts[k].share * (1.0 - cuts[k].share) / kDraws);
        EXPECT_NEAR(static_cast<double>(counts[k]) / kDraws, cuts[k].share, 4.0 * std::hypot(sd, cuts[k].error))
            << "d = " << d << ", kind " << kind;
      }
    }
  }
}

TEST(ConeSampler, DrawsUniformlyFromConesOfEveryKind) {
  expect_uniform_draws(std::array<std::size_t, 5>{2, 3, 4, 5, 6}, 4, 6);
}

TEST(ConeSamplerSlow, DrawsUniformlyFromConesOfEveryKindInSevenAndEight) {
  expect_uniform_draws(std::array<std::size_t, 2>{7, 8}, 4, 12);
}

// Of 2000 points the shares on one side of a cut: off by less than independent points would be, in the mean square.
TEST(ConeSampler, CoversMoreEvenlyThanIndependentPoints) {
  RandomStream random{7};
  constexpr std::size_t kPoints = 2000;
  double squares = 0.0;
  double count = 0.0;
  for (const std::size_t d : std::array<std::size_t, 4>{2, 4, 5, 8}) {
    for (std::size_t kind = 0; kind < (d == 8 ? 3 : 4); ++kind) {
      const Cone cone = cone_of_kind(d, kind, random);
      const Eigen::MatrixXd points = cover(cone, kPoints);
      ASSERT_EQ(points.rows(), static_cast<Eigen::Index>(d));
      ASSERT_EQ(points.cols(), static_cast<Eigen::Index>(kPoints));
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        ASSERT_NEAR(points.col(i).norm(), 1.0, 1e-14);
        ASSERT_GE(worst_margin(cone, points.col(i)), -1e-14);
      }
      const Cloud cloud{ConeSampler{cone}, kPoints};
      ASSERT_EQ(cloud.points(), points);
      for (const Cut& cut : cuts_of(cone, 3, random)) {
        const auto mask = cloud.mask(cut.half_space);
        const Share found = cloud.share({&mask});
        const double sd = std::sqrt(cut.share * (1.0 - cut.share) / kPoints);
        EXPECT_NEAR(found.standard_error, sd, 0.2 * sd);
        EXPECT_NEAR(found.value, cut.share, 4.0 * sd) << "d = " << d << ", kind " << kind;
        squares += std::pow((found.value - cut.share) / sd, 2.0);
        count += 1.0;
      }
    }
  }
  EXPECT_LT(squares / count, 0.6);
}

TEST(ConeSampler, IsThatOfTheConeInSpace) {
  RandomStream random{8};
  for (const Cone& cone : testing::random_cones(9, 6, random)) {
    const ConeSampler sampler{cone};
    RandomStream a{1}, b{1};
    ASSERT_EQ(sampler.sample(a), cone.sample(b));
    ASSERT_EQ(sampler.cover(7), fibonacci_cover(cone, 7));
    ASSERT_EQ(sampler.solid_angle().value, cone.solid_angle());
  }
  EXPECT_THROW((void)ConeSampler{Cone{4}}.cover(0), std::invalid_argument);
  EXPECT_THROW((void)ConeSampler{Cone{4}}.solid_angle(0), std::invalid_argument);
  EXPECT_THROW((void)Cone{4}.sample(random), std::invalid_argument);
  EXPECT_THROW((void)fibonacci_cover(Cone{4}, 5), std::invalid_argument);
}

TEST(Cloud, CountsIntersectionsAsTheConjunctionOfMasks) {
  RandomStream random{9};
  const auto system = testing::random_feasible_system(5, 4, random, 5);
  const Cloud cloud{ConeSampler{Cone{5}}, 1000};
  const auto first = cloud.mask(system[0]);
  const auto rest = cloud.mask(std::span{system}.subspan(1));
  const Cone cone = cone_of(5, system);
  double inside = 0.0;
  for (Eigen::Index i = 0; i < cloud.points().cols(); ++i) inside += cone.contains(cloud.points().col(i)) ? 1.0 : 0.0;
  EXPECT_DOUBLE_EQ(cloud.share({&first, &rest}).value, inside / 1000.0);
  EXPECT_EQ(cloud.share({}).value, 1.0);
  EXPECT_GT(cloud.share({}).standard_error, 0.0);
  EXPECT_THROW((void)cloud.mask(HalfSpace{{1, 0}}), std::invalid_argument);
  const Cloud::Mask short_mask(1);
  EXPECT_THROW((void)cloud.share({&short_mask}), std::invalid_argument);
}

TEST(Sobol, AgreesWithAnotherImplementation) {
  boost::random::sobol other{detail::Sobol::kMaxDimension};
  detail::Sobol sobol{detail::Sobol::Shift{}};
  sobol.next();  // the origin, which the other leaves out
  for (int i = 0; i < 1000; ++i) {
    sobol.next();
    for (std::size_t k = 0; k < detail::Sobol::kMaxDimension; ++k) {
      ASSERT_NEAR(sobol[k], static_cast<double>(other()) * 0x1.0p-64, 1e-9) << i << ", " << k;
    }
  }
}

}  // namespace
}  // namespace kith
