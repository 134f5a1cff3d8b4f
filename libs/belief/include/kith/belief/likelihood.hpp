#pragma once

#include <cstddef>
#include <string_view>

namespace kith {

/// How the density falls off beyond the boundary of a half-space.
enum class LikelihoodForm {
  kDiscontinuous,  ///< von Mises-Fisher on the far side, with a jump at the boundary.
  kContinuous,     ///< The same shape scaled to meet the near side at the boundary.
};

/// p(x | c): how probable the unit weights x are to a person of learning ability
/// beta who was shown the half-space with unit normal u, as a density on the
/// sphere of d dimensions (in 1/sr for d = 3). With t = u . x, in three dimensions:
///
///   t >= 0:  beta / (2 pi)
///   t <  0:  discontinuous  kappa / (4 pi sinh kappa) * exp(kappa t),  kappa = ln(beta / (1 - beta))
///            continuous     beta / (2 pi) * exp(kappa t),  (1 - exp(-kappa)) / kappa = (1 - beta) / beta
///
/// so that beta is the mass on the near side; the total mass is 1.
/// [jayaraman2024, section III]; kappa in closed form (docs/notation.md). In other dimensions the same shapes: beta
/// over half the sphere's area on the near side, exp(kappa t) beyond, with kappa such that the whole von Mises-Fisher
/// density, or its half, leaves 1 - beta there; by quadrature, to 12 digits for every ability below 1.
class HalfSpaceLikelihood {
 public:
  /// @throws std::invalid_argument unless 0.5 <= ability <= 1 (below 0.5 a person would learn the opposite) and
  /// 2 <= dimension <= 8.
  explicit HalfSpaceLikelihood(double ability, LikelihoodForm form = LikelihoodForm::kDiscontinuous,
                               std::size_t dimension = 3);

  [[nodiscard]] double ability() const noexcept { return ability_; }
  [[nodiscard]] LikelihoodForm form() const noexcept { return form_; }
  /// d.
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }
  /// kappa; infinite at ability 1.
  [[nodiscard]] double concentration() const noexcept { return kappa_; }
  /// Whether the far side is impossible (ability 1).
  [[nodiscard]] bool is_hard() const noexcept;

  /// The density at t = u . x.
  [[nodiscard]] double density(double t) const noexcept;
  [[nodiscard]] double log_density(double t) const noexcept;
  /// log of density(t) / density of the near side; 0 for t >= 0, -infinity where impossible:
  ///   t < 0:  log_far() + concentration() * t.
  [[nodiscard]] double log_relative(double t) const noexcept;
  [[nodiscard]] double log_far() const noexcept { return log_far_; }

 private:
  double ability_;
  LikelihoodForm form_;
  std::size_t dimension_;
  double kappa_;
  double log_near_;  // log density on the near side
  double log_far_;   // log relative density just beyond the boundary
};

/// The ability whose log-odds are `scale` times those of `ability`:
/// logit(result) = scale * logit(ability). 1 stays 1. @pre 0.5 <= ability <= 1, scale > 0.
[[nodiscard]] double scaled_ability(double ability, double scale);

}  // namespace kith
