#include "kith/random/batch_normal.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

constexpr std::size_t kBlock = 256;  // pairs at a time: all of it stays in the first-level cache
using Words = std::array<std::uint32_t, kBlock>;
using Doubles = std::array<double, kBlock>;

// An integer below 2^52 as a double, without a conversion instruction.
double to_double(std::uint64_t n) noexcept { return std::bit_cast<double>(0x4330000000000000ull | n) - 0x1.0p52; }

// 32 bits for the radius and 32 for the angle of kBlock pairs; each counter serves two pairs.
void fill_words(std::uint64_t first, const r123::Philox4x32::key_type& key, Words& radius, Words& angle) noexcept {
  r123::Philox4x32 philox;
  for (std::size_t i = 0; i < kBlock; i += 2) {
    const std::uint64_t counter = first + i / 2;
    const auto word =
        philox({{static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), 0, 0}}, key);
    radius[i] = word[0];
    angle[i] = word[1];
    radius[i + 1] = word[2];
    angle[i + 1] = word[3];
  }
}

// sqrt(-2 ln u) at u = (word + 1/2) / 2^32. With u = 2^e m and sqrt(1/2) <= m < sqrt(2),
// ln m = 2 artanh(s) for s = (m - 1) / (m + 1), |s| < 0.172.
KITH_VECTOR_CLONES void radii(const Words& words, Doubles& out) noexcept {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double u = (to_double(words[i]) + 0.5) * 0x1.0p-32;
    // Subtracting the bits of sqrt(1/2) makes the exponent field count from there.
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(u) - 0x3FE6A09E667F3BCDull;
    const double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFull) + 0x3FE6A09E667F3BCDull);
    // Exponents run from -33 to 0: shifted by 64, they are the small non-negative integers above.
    const double e = to_double(((bits + (64ull << 52)) >> 52) & 0xFFFull) - 64.0;
    const double s = (m - 1.0) / (m + 1.0);
    const double q = s * s;
    double p = 1.0 / 21.0;
    p = p * q + 1.0 / 19.0;
    p = p * q + 1.0 / 17.0;
    p = p * q + 1.0 / 15.0;
    p = p * q + 1.0 / 13.0;
    p = p * q + 1.0 / 11.0;
    p = p * q + 1.0 / 9.0;
    p = p * q + 1.0 / 7.0;
    p = p * q + 1.0 / 5.0;
    p = p * q + 1.0 / 3.0;
    const double log_m = 2.0 * s + 2.0 * s * q * p;
    out[i] = std::sqrt(-2.0 * (e * std::numbers::ln2 + log_m));
  }
}

// cos and sin of an angle that is uniform on the circle: the upper two bits choose
// the quadrant, the rest an angle a in (-pi/4, pi/4) about its axis.
KITH_VECTOR_CLONES void directions(const Words& words, Doubles& cosine, Doubles& sine) noexcept {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double a = (to_double(words[i] & 0x3FFFFFFFu) + (0.5 - 0x1.0p29)) * (0.5 * std::numbers::pi * 0x1.0p-30);
    const double q = a * a;
    double s = -1.0 / 1307674368000.0;
    s = s * q + 1.0 / 6227020800.0;
    s = s * q - 1.0 / 39916800.0;
    s = s * q + 1.0 / 362880.0;
    s = s * q - 1.0 / 5040.0;
    s = s * q + 1.0 / 120.0;
    s = s * q - 1.0 / 6.0;
    s = a + a * q * s;
    double c = 1.0 / 20922789888000.0;
    c = c * q - 1.0 / 87178291200.0;
    c = c * q + 1.0 / 479001600.0;
    c = c * q - 1.0 / 3628800.0;
    c = c * q + 1.0 / 40320.0;
    c = c * q - 1.0 / 720.0;
    c = c * q + 1.0 / 24.0;
    c = 1.0 - 0.5 * q + q * q * c;
    // A quarter turn maps (c, s) to (-s, c), a half turn negates both: swap on
    // bit 30, then flip signs, all on the bit patterns so that nothing branches.
    const std::uint64_t quarter = (words[i] >> 30) & 1u;
    const std::uint64_t half = words[i] >> 31;
    const std::uint64_t swap = std::uint64_t{0} - quarter;
    const std::uint64_t bits_c = std::bit_cast<std::uint64_t>(c);
    const std::uint64_t bits_s = std::bit_cast<std::uint64_t>(s);
    const std::uint64_t exchange = (bits_c ^ bits_s) & swap;
    cosine[i] = std::bit_cast<double>((bits_c ^ exchange) ^ ((quarter ^ half) << 63));
    sine[i] = std::bit_cast<double>((bits_s ^ exchange) ^ (half << 63));
  }
}

}  // namespace

void batch_standard_normal(std::span<double> out, RandomStream& random) noexcept {
  const std::uint32_t k0 = random();
  const std::uint32_t k1 = random();
  const r123::Philox4x32::key_type key{{k0, k1}};
  const std::size_t pairs = (out.size() + 1) / 2;
  Words radius_words;
  Words angle_words;
  Doubles radius;
  Doubles cosine;
  Doubles sine;
  for (std::size_t begin = 0; begin < pairs; begin += kBlock) {
    fill_words(begin / 2, key, radius_words, angle_words);
    radii(radius_words, radius);
    directions(angle_words, cosine, sine);
    const std::size_t n = std::min(kBlock, pairs - begin);
    for (std::size_t i = 0; i < n; ++i) out[begin + i] = radius[i] * cosine[i];
    const std::size_t n_sine = std::min(n, out.size() - pairs - std::min(begin, out.size() - pairs));
    for (std::size_t i = 0; i < n_sine; ++i) out[pairs + begin + i] = radius[i] * sine[i];
  }
}

}  // namespace kith
