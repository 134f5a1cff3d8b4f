#include "likelihood_integrals.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace kith::detail {
namespace {

// The kappa at which a function that falls from 1 at kappa = 0 towards 0 takes the value `odds`.
template <typename Function>
double where_it_falls_to(double odds, Function function) {
  if (odds >= 1.0) return 0.0;
  const double target = std::log(odds);
  const auto excess = [&](double kappa) { return std::log(function(kappa)) - target; };
  double upper = 1.0;
  while (excess(upper) > 0.0) upper *= 2.0;
  std::uintmax_t steps = 100;
  const auto [below, above] =
      boost::math::tools::toms748_solve(excess, 0.0, upper, boost::math::tools::eps_tolerance<double>{50}, steps);
  return 0.5 * (below + above);
}

}  // namespace

double far_integral(double kappa, std::size_t dimension) {
  const auto power = static_cast<int>(dimension) - 2;
  const auto integrand = [&](double u) { return std::exp(-kappa * std::sin(u)) * std::pow(std::cos(u), power); };
  constexpr unsigned kMostHalvings = 12;
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, 0.0, std::numbers::pi / 2.0,
                                                                       kMostHalvings, 1e-13);
}

double concentration_of_sphere(double odds, std::size_t dimension) {
  return where_it_falls_to(
      odds, [&](double kappa) { return far_integral(kappa, dimension) / far_integral(-kappa, dimension); });
}

double concentration_of_half(double odds, std::size_t dimension) {
  const double half = far_integral(0.0, dimension);
  return where_it_falls_to(odds, [&](double kappa) { return far_integral(kappa, dimension) / half; });
}

}  // namespace kith::detail
