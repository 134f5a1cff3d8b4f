#pragma once

#include <cstddef>

// Integrals of the von Mises-Fisher density over half of the sphere of d dimensions, where no closed form exists.
namespace kith::detail {

// int_0^{pi/2} exp(-kappa sin u) cos(u)^(d-2) du: the mass of exp(kappa t), t = -sin u, on the far half of the sphere,
// but for the area of the sphere of d - 1 dimensions. To about 14 digits for any kappa. @pre kappa >= 0, d >= 2.
[[nodiscard]] double far_integral(double kappa, std::size_t dimension);

// The kappa >= 0 for which the far half has odds (1 - ability) / ability against the near one:
// far_integral(kappa) / far_integral(-kappa). To about 14 digits, however small the odds are or how near to 1.
// @pre 0.5 <= ability < 1, d >= 2.
[[nodiscard]] double concentration_of_sphere(double ability, std::size_t dimension);

// The kappa >= 0 for which far_integral(kappa) / far_integral(0) has these odds. @pre 0.5 <= ability < 1, d >= 2.
[[nodiscard]] double concentration_of_half(double ability, std::size_t dimension);

}  // namespace kith::detail
