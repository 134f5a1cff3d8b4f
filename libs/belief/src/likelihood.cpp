#include "kith/belief/likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "kith/core/math.hpp"
#include "kith/geometry/cone.hpp"
#include "likelihood_integrals.hpp"

namespace kith {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kSpace = 3;  // where everything has a closed form

std::size_t checked_dimension(std::size_t dimension) {
  if (dimension < 2 || dimension > IntegerVector::kMaxDimension) {
    throw std::invalid_argument("HalfSpaceLikelihood: the dimension must lie in [2, 8], got " +
                                std::to_string(dimension));
  }
  return dimension;
}

double checked_ability(double ability) {
  if (!(ability >= 0.5 && ability <= 1.0)) {
    throw std::invalid_argument("HalfSpaceLikelihood: the ability must lie in [0.5, 1], got " +
                                std::to_string(ability));
  }
  return ability;
}

// The positive root of q k + exp(-k) - 1, for q = (1 - beta) / beta. The
// function is convex and its root lies left of 1/q, so Newton's iteration from
// there falls monotonically until rounding stops it. Near 0.5 its terms cancel.
double continuous_concentration(double ability) {
  constexpr double kCancels = 0.501;
  if (ability < kCancels) return detail::concentration_of_half(ability, kSpace);
  const double q = (1.0 - ability) / ability;
  double k = 1.0 / q;
  for (int step = 0; step < 200; ++step) {
    const double slope = q - math::exp(-k);
    const double next = k - (q * k + math::expm1(-k)) / slope;
    if (!(slope > 0.0) || !(next < k)) break;
    k = next;
  }
  return k;
}

// ln(beta / (1 - beta)), exact near 0.5.
double log_odds(double ability) { return math::log1p((2.0 * ability - 1.0) / (1.0 - ability)); }

double concentration_for(double ability, LikelihoodForm form, std::size_t dimension) {
  if (ability >= 1.0) return kInfinity;
  const bool jumps = form == LikelihoodForm::kDiscontinuous;
  if (dimension == kSpace) return jumps ? log_odds(ability) : continuous_concentration(ability);
  return jumps ? detail::concentration_of_sphere(ability, dimension)
               : detail::concentration_of_half(ability, dimension);
}

// log of the density just beyond the boundary over that on the near side: 1 - beta over the mass of exp(kappa t) on the
// far half, relative to beta over the near half. In space log of kappa (2 / (4 sinh kappa)) / beta: with s = 2 beta - 1
// the sine hyperbolic is s / (2 beta (1 - beta)), which leaves (1 - beta) kappa / s.
double discontinuous_log_far(double ability, double kappa, std::size_t dimension) {
  const double s = 2.0 * ability - 1.0;
  if (s <= 0.0) return 0.0;
  if (ability >= 1.0) return -kInfinity;
  if (dimension == kSpace) return std::min(0.0, math::log((1.0 - ability) * (kappa / s)));
  const double ratio = detail::far_integral(0.0, dimension) / detail::far_integral(kappa, dimension);
  return std::min(0.0, math::log((1.0 - ability) / ability * ratio));
}

double half_area(std::size_t dimension) {
  return dimension == kSpace ? 2.0 * std::numbers::pi : 0.5 * sphere_area(dimension);
}

}  // namespace

HalfSpaceLikelihood::HalfSpaceLikelihood(double ability, LikelihoodForm form, std::size_t dimension)
    : ability_{checked_ability(ability)},
      form_{form},
      dimension_{checked_dimension(dimension)},
      kappa_{concentration_for(ability, form, dimension)},
      log_near_{math::log(ability / half_area(dimension))},
      log_far_{form == LikelihoodForm::kDiscontinuous ? discontinuous_log_far(ability, kappa_, dimension) : 0.0} {}

bool HalfSpaceLikelihood::is_hard() const noexcept { return ability_ >= 1.0; }

double HalfSpaceLikelihood::density(double t) const noexcept {
  const double near = ability_ / half_area(dimension_);
  return t >= 0.0 ? near : near * math::exp(log_relative(t));
}

double HalfSpaceLikelihood::log_density(double t) const noexcept { return log_near_ + log_relative(t); }

double HalfSpaceLikelihood::log_relative(double t) const noexcept { return t >= 0.0 ? 0.0 : log_far_ + kappa_ * t; }

double scaled_ability(double ability, double scale) {
  if (!(ability >= 0.5 && ability <= 1.0)) {
    throw std::invalid_argument("scaled_ability: the ability must lie in [0.5, 1]");
  }
  if (!(scale > 0.0 && std::isfinite(scale))) {
    throw std::invalid_argument("scaled_ability: the scale must be positive and finite");
  }
  if (ability >= 1.0 || scale == 1.0) return ability;  // 1 stays 1, and no scale changes no bit
  return 1.0 / (1.0 + math::pow((1.0 - ability) / ability, scale));
}

}  // namespace kith
