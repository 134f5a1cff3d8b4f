#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kith/random/stream.hpp"

namespace kith {

// Own distributions: those of the standard library differ between
// implementations. Each takes the stream last and documents its draws.

/// Uniform on [0, 1) with 53 random bits; 2 draws of 32 bits.
[[nodiscard]] double uniform01(RandomStream& random) noexcept;

/// Uniform on {0, ..., n-1} without bias (Lemire 2019). @pre n > 0.
[[nodiscard]] std::size_t uniform_index(std::size_t n, RandomStream& random);

/// A standard normal deviate (Box-Muller, the cosine branch; 4 draws).
[[nodiscard]] double standard_normal(RandomStream& random) noexcept;

/// Fills `out` with independent standard normals (Box-Muller, both branches).
/// The values depend on the stream and out.size() only.
void fill_standard_normal(std::span<double> out, RandomStream& random) noexcept;

/// |N(0, sigma^2)|; mean sigma * sqrt(2 / pi). @pre sigma >= 0.
[[nodiscard]] double half_normal(double sigma, RandomStream& random);

/// Index i with probability weights[i] / sum. Weights are >= 0 with a positive, finite sum.
/// @throws std::invalid_argument otherwise.
[[nodiscard]] std::size_t categorical(std::span<const double> weights, RandomStream& random);

/// A uniform point of the unit sphere in three dimensions (Archimedes: z and azimuth uniform).
[[nodiscard]] std::array<double, 3> uniform_on_sphere(RandomStream& random) noexcept;

/// A von Mises-Fisher draw on the sphere in three dimensions with unit mean
/// direction and concentration kappa >= 0 (Jakob 2012, closed-form inverse).
[[nodiscard]] std::array<double, 3> von_mises_fisher(std::span<const double, 3> mean, double kappa, RandomStream& random);

}  // namespace kith
