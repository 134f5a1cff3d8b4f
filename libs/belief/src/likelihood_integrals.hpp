#pragma once

#include <cstddef>

// Integrals of the von Mises-Fisher density over half of the sphere of d dimensions, where no closed form exists.
namespace kith::detail {

// int_0^{pi/2} exp(-kappa sin u) cos(u)^(d-2) du: the mass of exp(kappa t), t = -sin u, on the far half of the sphere,
// but for the area of the sphere of d - 1 dimensions. @pre d >= 2.
[[nodiscard]] double far_integral(double kappa, std::size_t dimension);

// The kappa >= 0 for which far_integral(kappa) / far_integral(-kappa) = odds: the far half has odds against the near
// one. @pre 0 < odds <= 1.
[[nodiscard]] double concentration_of_sphere(double odds, std::size_t dimension);

// The kappa >= 0 for which far_integral(kappa) / far_integral(0) = odds. @pre 0 < odds <= 1.
[[nodiscard]] double concentration_of_half(double odds, std::size_t dimension);

}  // namespace kith::detail
