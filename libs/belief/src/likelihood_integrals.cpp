#include "likelihood_integrals.hpp"

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cstdint>
#include <numbers>
#include <vector>

#include "kith/core/math.hpp"

namespace kith::detail {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2.0;

// Quadrature over [0, upper] in parts.
template <typename Integrand>
double over_parts(double upper, Integrand integrand) {
  constexpr int kParts = 4;
  const double width = upper / kParts;
  double sum = 0.0;
  for (int part = 0; part < kParts; ++part)
    sum += boost::math::quadrature::gauss<double, 30>::integrate(integrand, part * width, (part + 1) * width);
  return sum;
}

// What the integrand below needs of u.
struct Node {
  double sine;
  double power;  // cos(u)^(d-2)
};
Node node_at(double u, std::size_t dimension) {
  double power = 1.0;
  for (std::size_t k = 2; k < dimension; ++k) power *= math::cos(u);
  return {math::sin(u), power};
}

// The nodes of a right angle, in the order in which quadrature asks for them.
std::vector<Node> nodes_of_right_angle(std::size_t dimension) {
  std::vector<Node> nodes;
  (void)over_parts(kRightAngle, [&](double u) { return nodes.push_back(node_at(u, dimension)), 0.0; });
  return nodes;
}

// int_0^upper value(sin u) cos(u)^(d-2) du of a function that falls or rises by at most about exp(60) on the way, so
// that it is smooth in each part: quadrature over the whole right angle would miss a narrow peak at 0.
template <typename Function>
double integral(std::size_t dimension, double upper, Function value) {
  if (upper < kRightAngle) {
    return over_parts(upper, [&](double u) {
      const auto [sine, power] = node_at(u, dimension);
      return value(sine) * power;
    });
  }
  constexpr std::size_t kMostDimensions = 8;
  static const auto kNodes = [] {
    std::array<std::vector<Node>, kMostDimensions + 1> nodes;
    for (std::size_t d = 2; d <= kMostDimensions; ++d) nodes[d] = nodes_of_right_angle(d);
    return nodes;
  }();
  const auto* node = kNodes.at(dimension).data();
  return over_parts(upper, [&](double) {
    const auto [sine, power] = *node++;
    return value(sine) * power;
  });
}

// exp(-kappa) far_integral(-kappa): the near half, relative to its largest density.
double scaled_near_integral(double kappa, std::size_t dimension) {
  return integral(dimension, kRightAngle, [&](double t) { return math::exp(kappa * (t - 1.0)); });
}

double sinh(double x) {
  const double e = math::expm1(x);
  return 0.5 * (e + e / (1.0 + e));
}

// The kappa > 0 at which a rising function is 0, from a guess of the right order.
template <typename Function>
double root_near(double guess, Function rising) {
  std::uintmax_t steps = 200;
  constexpr double kWiden = 2.0;
  const auto [below, above] = boost::math::tools::bracket_and_solve_root(
      rising, guess, kWiden, true, boost::math::tools::eps_tolerance<double>{50}, steps);
  return 0.5 * (below + above);
}

constexpr double kLargeOdds = 0.5;  // above it, 1 - odds is solved for, which keeps its digits near odds of 1

}  // namespace

double far_integral(double kappa, std::size_t dimension) {
  constexpr double kNothing = 40.0;  // exp(-40) is less than a double resolves beside 1
  const double upper = kappa > kNothing ? math::asin(kNothing / kappa) : kRightAngle;
  return integral(dimension, upper, [&](double t) { return math::exp(-kappa * t); });
}

double concentration_of_sphere(double ability, std::size_t dimension) {
  const double s = 2.0 * ability - 1.0;  // (near - far) / (near + far), exactly
  if (s <= 0.0) return 0.0;
  const double log_odds = math::log1p(2.0 * s / (1.0 - s));  // the concentration in space
  if (s < kLargeOdds) {
    return root_near(log_odds, [&](double kappa) {
      const double odd = integral(dimension, kRightAngle, [&](double t) { return sinh(kappa * t); });
      const double even =
          integral(dimension, kRightAngle, [&](double t) { return sinh(kappa * t) + math::exp(-kappa * t); });
      return odd / even - s;
    });
  }
  return root_near(log_odds, [&](double kappa) {
    const double ratio = scaled_near_integral(kappa, dimension) / far_integral(kappa, dimension);
    return kappa + math::log(ratio) - log_odds;
  });
}

double concentration_of_half(double ability, std::size_t dimension) {
  const double s = 2.0 * ability - 1.0;
  if (s <= 0.0) return 0.0;
  const double odds = (1.0 - ability) / ability;
  const double half = far_integral(0.0, dimension);
  const double guess = s / (1.0 - ability);  // right in order at both ends
  if (odds > kLargeOdds) {
    return root_near(guess, [&](double kappa) {
      const double lost = integral(dimension, kRightAngle, [&](double t) { return -math::expm1(-kappa * t); });
      return lost / half - s / ability;
    });
  }
  return root_near(guess, [&](double kappa) { return math::log(odds * half / far_integral(kappa, dimension)); });
}

}  // namespace kith::detail
