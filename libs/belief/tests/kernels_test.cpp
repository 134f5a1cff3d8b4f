#include "../src/kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "kith/core/batch_normal.hpp"
#include "kith/core/distributions.hpp"
#include "script.hpp"

namespace kith::detail {
namespace {

struct Cloud {
  std::vector<double> x, y, z, weights;
  [[nodiscard]] Points points() const { return {x, y, z}; }
  [[nodiscard]] MutablePoints mutable_points() { return {x, y, z}; }
  [[nodiscard]] Eigen::Vector3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

Cloud random_cloud(std::size_t n, RandomStream& random) {
  Cloud cloud;
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double height = 1.0 - 2.0 * uniform01(random);
    const double azimuth = 2.0 * std::numbers::pi * uniform01(random);
    const double radius = std::sqrt((1.0 - height) * (1.0 + height));
    cloud.x.push_back(radius * std::cos(azimuth));
    cloud.y.push_back(radius * std::sin(azimuth));
    cloud.z.push_back(height);
    cloud.weights.push_back(uniform01(random));
    sum += cloud.weights.back();
  }
  for (double& w : cloud.weights) w /= sum;
  return cloud;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2.0 * std::atan2((a - b).norm(), (a + b).norm());
}

TEST(ExpBelow, AgreesWithTheStandardLibraryToOneInTenToTheFifteen) {
  RandomStream random{1};
  std::vector<double> in{0.0, -0.0, -1e-300, -1e-9, -708.0, -707.99};
  for (int i = 0; i < 100'000; ++i) in.push_back(-708.0 * uniform01(random) * uniform01(random));
  std::vector<double> out(in.size());
  (void)exp_below(in, 0.0, out);
  double worst = 0.0;
  for (std::size_t i = 0; i < in.size(); ++i) worst = std::max(worst, std::abs(out[i] / std::exp(in[i]) - 1.0));
  EXPECT_LT(worst, 1e-15);
  EXPECT_EQ(out[0], 1.0);
}

TEST(ExpBelow, IsZeroFarBelowAndSumsWhatItWrites) {
  const std::vector<double> in{3.0, 3.0 - 709.0, -1e300, -std::numeric_limits<double>::infinity(), 2.0};
  std::vector<double> out(in.size());
  EXPECT_DOUBLE_EQ(exp_below(in, 3.0, out), 1.0 + std::exp(-1.0));
  EXPECT_EQ(out[1], 0.0);
  EXPECT_EQ(out[2], 0.0);
  EXPECT_EQ(out[3], 0.0);
}

TEST(Largest, FindsTheMaximumAtEveryPosition) {
  for (std::size_t n = 1; n < 40; ++n) {
    for (std::size_t at = 0; at < n; ++at) {
      std::vector<double> values(n, -std::numeric_limits<double>::infinity());
      values[at] = -3.0;
      ASSERT_EQ(largest(values), -3.0);
    }
  }
}

TEST(LogRelativeProducts, SumsTheLikelihoodsOfThePlanes) {
  RandomStream random{2};
  for (const auto form : {LikelihoodForm::kDiscontinuous, LikelihoodForm::kContinuous}) {
    for (const double ability : {0.7, 0.95, 1.0}) {
      const HalfSpaceLikelihood likelihood{ability, form};
      const Cloud cloud = random_cloud(67, random);
      auto list = kith::testing::random_list(5, random);
      list.push_back(list[2]);
      std::vector<double> out(67);
      log_relative_products(cloud.points(), Planes{list, likelihood}.list(), out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        double expected = 0.0;
        for (const HalfSpace& h : list) expected += likelihood.log_relative(h.margin(cloud.at(i)));
        if (std::isinf(expected)) {
          ASSERT_EQ(out[i], expected);
        } else {
          ASSERT_NEAR(out[i], expected, 1e-13);
        }
      }
    }
  }
}

TEST(WeightedSquareAngles, AgreesWithArcTangents) {
  RandomStream random{3};
  const Cloud cloud = random_cloud(1000, random);
  for (std::size_t i = 0; i < 20; ++i) {
    const Eigen::Vector3d centre = i == 0 ? Eigen::Vector3d{-cloud.at(3)} : cloud.at(i);
    double expected = 0.0;
    for (std::size_t k = 0; k < 1000; ++k) {
      const double angle = angle_between(cloud.at(k), centre);
      expected += cloud.weights[k] * angle * angle;
    }
    EXPECT_NEAR(weighted_square_angles(cloud.points(), cloud.weights, centre) / expected, 1.0, 1e-12);
  }
}

TEST(WeightedSquareAngles, KeepsSmallAndWideAngles) {
  const std::vector<double> one{1.0};
  for (const double angle : {1e-9, 1e-4, 0.3, 1.57, 1.58, 3.0, 3.14159}) {
    const std::vector<double> x{std::sin(angle)}, y{0.0}, z{std::cos(angle)};
    const double square = weighted_square_angles({x, y, z}, one, Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(square / (angle * angle), 1.0, 1e-11) << angle;
  }
}

TEST(RoughSquareAngles, AgreesToOneInAHundredThousand) {
  RandomStream random{8};
  for (const double width : {0.01, 0.2, 4.0}) {  // from a spot to the whole sphere
    Cloud cloud = random_cloud(1000, random);
    const Eigen::Vector3d centre = cloud.at(0);
    for (std::size_t i = 0; i < 1000; ++i) {
      const Eigen::Vector3d p = (centre + width * cloud.at(i)).normalized();
      cloud.x[i] = p.x();
      cloud.y[i] = p.y();
      cloud.z[i] = p.z();
    }
    const double exact = weighted_square_angles(cloud.points(), cloud.weights, centre);
    EXPECT_NEAR(rough_square_angles(cloud.points(), cloud.weights, centre) / exact, 1.0, 1e-5) << width;
  }
}

TEST(WeightInside, CountsWhatTheHalfSpacesContain) {
  RandomStream random{4};
  const Cloud cloud = random_cloud(777, random);
  for (std::size_t n = 0; n < 5; ++n) {
    const auto list = kith::testing::random_list(n, random);
    double expected = 0.0;
    for (std::size_t i = 0; i < 777; ++i) {
      const bool inside =
          std::all_of(list.begin(), list.end(), [&](const HalfSpace& h) { return h.contains(cloud.at(i)); });
      expected += inside ? cloud.weights[i] : 0.0;
    }
    EXPECT_NEAR(weight_inside(cloud.points(), cloud.weights, list), expected, 1e-13);
  }
}

// In the tangent plane at the start the displacement is N(0, angle^2) in every
// direction: the moments of the geodesic distance r are E r^2 = 2 angle^2,
// E r^4 = 8 angle^4. n = 60 000: 5 standard errors are 2.1 % and 4.6 %.
TEST(MovePoints, SpreadsAsANormalInTheTangentPlane) {
  constexpr std::size_t n = 60'000;
  for (const double angle : {0.01, 0.1, 0.5}) {
    for (const Eigen::Vector3d& start :
         {Eigen::Vector3d{0, 0, 1}, Eigen::Vector3d{0, 0, -1}, Eigen::Vector3d{0.6, -0.48, 0.64}}) {
      Cloud cloud{
          std::vector<double>(n, start.x()), std::vector<double>(n, start.y()), std::vector<double>(n, start.z()), {}};
      RandomStream random{5};
      move_points(cloud.points(), angle, {}, random, cloud.mutable_points());
      double second = 0.0;
      double fourth = 0.0;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_NEAR(cloud.at(i).norm(), 1.0, 1e-15);
        const double r = angle_between(cloud.at(i), start);
        if (r < 3.0) second += r * r / static_cast<double>(n);  // at 0.5 wrapping around the sphere is 2e-9
        fourth += r * r * r * r / static_cast<double>(n);
        mean += cloud.at(i) / static_cast<double>(n);
      }
      EXPECT_NEAR(second / (2.0 * angle * angle), 1.0, 0.021);
      EXPECT_NEAR(fourth / (8.0 * std::pow(angle, 4)), 1.0, 0.047);
      EXPECT_LT((mean - start * mean.dot(start)).norm(), 5.0 * angle * std::sqrt(2.0 / static_cast<double>(n)));
    }
  }
}

// The same draws, the tangent plane's frame and the exponential map in double precision.
TEST(MovePoints, IsTheExponentialMapToSinglePrecision) {
  RandomStream random{9};
  for (const double angle : {1e-4, 0.03, 0.3}) {
    Cloud cloud = random_cloud(700, random);
    const Cloud start = cloud;
    const RandomStream stream = random.split("move");
    RandomStream moving = stream;
    move_points(start.points(), angle, {}, moving, cloud.mutable_points());
    RandomStream drawing = stream;
    const NormalPairs normal{drawing};
    NormalPairs::Block along, across;
    for (std::size_t i = 0; i < 700; ++i) {
      if (i % NormalPairs::kBlock == 0) normal.fill(i / NormalPairs::kBlock, along, across);
      const double s = angle * static_cast<double>(along[i % NormalPairs::kBlock]);
      const double t = angle * static_cast<double>(across[i % NormalPairs::kBlock]);
      const Eigen::Vector3d p = start.at(i);
      const double sign = p.z() < 0.0 ? -1.0 : 1.0;
      const double a = -1.0 / (sign + p.z());
      const Eigen::Vector3d first{1.0 + sign * p.x() * p.x() * a, sign * p.x() * p.y() * a, -sign * p.x()};
      const Eigen::Vector3d second = p.cross(first);
      const double r = std::hypot(s, t);
      const Eigen::Vector3d to = std::cos(r) * p + std::sin(r) / r * (s * first + t * second);
      ASSERT_LT((cloud.at(i) - to).norm(), 1e-6 * r) << angle;
    }
  }
}

// In place is the same as from one array to another.
TEST(MovePoints, MayMoveInPlace) {
  RandomStream random{10};
  Cloud here = random_cloud(600, random);
  Cloud there = here;
  const std::vector<Eigen::Vector3d> normals{Eigen::Vector3d::UnitZ()};
  RandomStream a{11};
  RandomStream b{11};
  move_points(here.points(), 0.3, normals, a, there.mutable_points());
  move_points(here.points(), 0.3, normals, b, here.mutable_points());
  EXPECT_EQ(here.x, there.x);
  EXPECT_EQ(here.y, there.y);
  EXPECT_EQ(here.z, there.z);
}

TEST(MovePoints, KeepsAPointThatFindsNoWayInside) {
  // Only the single direction x is inside all of these.
  const std::vector<Eigen::Vector3d> normals{Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY(),
                                             Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()};
  Cloud cloud{{1.0}, {0.0}, {0.0}, {1.0}};
  RandomStream random{6};
  move_points(cloud.points(), 0.1, normals, random, cloud.mutable_points());
  EXPECT_EQ(cloud.at(0), Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(MovePoints, StaysOnTheSphereOverThousandsOfMoves) {
  RandomStream random{7};
  Cloud cloud = random_cloud(50, random);
  for (int step = 0; step < 5000; ++step)
    move_points(cloud.points(), step % 7 == 0 ? 2.0 : 0.2, {}, random, cloud.mutable_points());
  for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(cloud.at(i).norm(), 1.0, 1e-15);
}

}  // namespace
}  // namespace kith::detail
