#pragma once

#include <span>

#include "kith/random/stream.hpp"

namespace kith {

/// Fills `out` with independent standard normals, many at a time: the
/// Box-Muller transform in plain loops with polynomials for the logarithm, the
/// sine and the cosine, which a compiler can vectorise. Several times as fast as
/// one call per number, for kernels that move thousands of particles.
///
/// One 64-bit key is drawn from the stream (2 draws); the numbers come from the
/// blocks 0, 1, 2, ... of Philox4x32-10 under that key, 32 bits for each radius
/// and 32 for each angle. The first and the second half of `out` hold the cosine
/// and the sine branch. So the values depend on the stream and out.size() only,
/// and no |value| exceeds sqrt(66 ln 2) = 6.77; a standard normal does so once
/// in 10^11 draws. The elementary functions are accurate to 4e-16.
void batch_standard_normal(std::span<double> out, RandomStream& random) noexcept;

}  // namespace kith
