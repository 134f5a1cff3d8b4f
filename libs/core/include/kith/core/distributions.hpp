#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kith/core/stream.hpp"

namespace kith {

// Own distributions: those of the standard library differ between
// implementations. Each takes the stream last and documents its draws.

/// Uniform on [0, 1) with 53 random bits; 2 draws of 32 bits.
[[nodiscard]] inline double uniform01(RandomStream& random) noexcept {
  const std::uint64_t upper = random() >> 5;  // 27 bits
  const std::uint64_t lower = random() >> 6;  // 26 bits
  return static_cast<double>((upper << 26) | lower) * 0x1.0p-53;
}

/// Uniform on {0, ..., n-1} without bias: multiply, keep the upper word, reject
/// the few products that would favour an index [lemire2019]. 1 draw of 32 bits
/// if n <= 2^32, else 2, and as many again after a rejection.
/// @throws std::invalid_argument if n == 0.
[[nodiscard]] std::size_t uniform_index(std::size_t n, RandomStream& random);

/// A standard normal deviate (Box-Muller, the cosine branch; 4 draws).
[[nodiscard]] double standard_normal(RandomStream& random) noexcept;

/// Fills `out` with independent standard normals (Box-Muller, both branches;
/// 4 draws for two values, the last branch of an odd size is dropped).
/// The values depend on the stream and out.size() only.
void fill_standard_normal(std::span<double> out, RandomStream& random) noexcept;

/// |N(0, sigma^2)|; mean sigma * sqrt(2 / pi); 4 draws.
/// @throws std::invalid_argument unless sigma is >= 0 and finite.
[[nodiscard]] double half_normal(double sigma, RandomStream& random);

/// Index i with probability weights[i] / sum; 2 draws. Never an index of weight 0.
/// Weights are >= 0 with a positive, finite sum.
/// @throws std::invalid_argument otherwise.
[[nodiscard]] std::size_t categorical(std::span<const double> weights, RandomStream& random);

}  // namespace kith
