#include "kith/study_design/response_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "kith/random/distributions.hpp"
#include "kith/study_design/space_filling.hpp"

namespace kith {
namespace {

std::vector<std::vector<double>> design(std::size_t n, std::size_t d) {
  auto points = latin_hypercube(n, d, 1, RandomStream{3});
  for (auto& point : points) {
    for (auto& x : point) x = 2.0 * x - 1.0;
  }
  return points;
}

double quadratic(const std::vector<double>& u) { return 1.0 + 2.0 * u[0] - u[1] * u[1] + 0.5 * u[0] * u[2]; }

TEST(LatinHypercube, HasEveryCoordinateOnceInEveryInterval) {
  const auto points = latin_hypercube(17, 4, 5, RandomStream{8});
  for (std::size_t k = 0; k < 4; ++k) {
    std::set<std::size_t> intervals;
    for (const auto& point : points) intervals.insert(static_cast<std::size_t>(point[k] * 17.0));
    EXPECT_EQ(intervals.size(), 17u);
  }
  EXPECT_EQ(points, latin_hypercube(17, 4, 5, RandomStream{8}));
}

TEST(ResponseSurface, ReproducesAQuadratic) {
  const auto points = design(60, 3);
  std::vector<double> values;
  for (const auto& point : points) values.push_back(quadratic(point));
  const ResponseSurface surface{points, values};
  EXPECT_LT(surface.error(), 0.01);
  EXPECT_GT(surface.explained(), 0.999);
  for (const auto& point : design(10, 3)) EXPECT_NEAR(surface.at(point), quadratic(point), 0.01);
  EXPECT_NEAR(surface.slope(0), 4.0, 0.02);
}

TEST(ResponseSurface, SharesTheVarianceAmongTheVariables) {
  const auto points = design(60, 3);
  std::vector<double> values;
  for (const auto& point : points) values.push_back(quadratic(point));
  const ResponseSurface surface{points, values};
  // By hand: Var(2x) = 4/3, Var(y^2) = 4/45, Var(xz / 2) = 1/36.
  const double all = 4.0 / 3.0 + 4.0 / 45.0 + 1.0 / 36.0;
  EXPECT_NEAR(surface.main_share(0), 4.0 / 3.0 / all, 0.01);
  EXPECT_NEAR(surface.main_share(1), 4.0 / 45.0 / all, 0.01);
  EXPECT_NEAR(surface.total_share(2), 1.0 / 36.0 / all, 0.01);
  EXPECT_NEAR(surface.main_share(2), 0.0, 0.001);
}

TEST(ResponseSurface, ExplainsNothingOfNoise) {
  const auto points = design(80, 3);
  RandomStream random{5};
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(standard_normal(random));
  const ResponseSurface surface{points, values};
  EXPECT_NEAR(surface.error(), 1.0, 0.3);  // the noise's sd is 1; its estimate from 80 values has an se of 0.08
  EXPECT_LT(surface.explained(), 0.2);
}

TEST(ResponseSurface, RefusesShapesThatDoNotFit) {
  const std::vector<std::vector<double>> points{{0.0}, {0.5}, {1.0}};
  EXPECT_THROW(ResponseSurface(points, std::vector<double>{1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(ResponseSurface(std::vector<std::vector<double>>{{0.0}}, std::vector<double>{1.0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace kith
