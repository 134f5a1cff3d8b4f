#include "kith/random/batch_normal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

constexpr std::size_t kBlock = NormalPairs::kBlock;  // all of it stays in the first-level cache

// An integer below 2^52 as a double, without a conversion instruction.
[[gnu::always_inline]] inline double to_double(std::uint64_t n) noexcept {
  return std::bit_cast<double>(0x4330000000000000ull | n) - 0x1.0p52;
}

// Philox4x32-10 of the counters first, first + 1, ...: 32 bits for the radius and 32 for the angle
// of kBlock pairs; each counter serves two. `first` is a multiple of kBlock / 2, so only its lowest bits count on.
KITH_VECTOR_CLONES void fill_words(std::uint64_t first, std::uint32_t key0, std::uint32_t key1, std::uint64_t* radius,
                                   std::uint64_t* angle) noexcept {
  constexpr std::uint64_t kLow = 0xFFFFFFFFu;
  const std::uint64_t low = first & kLow;
  const std::uint64_t high = first >> 32;
  KITH_INDEPENDENT_LOOP
  for (std::uint64_t i = 0; i < kBlock / 2; ++i) {
    std::uint64_t c0 = low + i;
    std::uint64_t c1 = high;
    std::uint64_t c2 = 0;
    std::uint64_t c3 = 0;
    std::uint32_t k0 = key0;
    std::uint32_t k1 = key1;
    for (int round = 0; round < 10; ++round) {  // in 64-bit lanes whose upper halves are masked off late
      const std::uint64_t p0 = 0xD2511F53u * (c0 & kLow);
      const std::uint64_t p1 = 0xCD9E8D57u * (c2 & kLow);
      c0 = (p1 >> 32) ^ c1 ^ k0;
      c1 = p1;
      c2 = (p0 >> 32) ^ c3 ^ k1;
      c3 = p0;
      k0 += 0x9E3779B9u;
      k1 += 0xBB67AE85u;
    }
    radius[2 * i] = c0 & kLow;
    angle[2 * i] = c1 & kLow;
    radius[2 * i + 1] = c2 & kLow;
    angle[2 * i + 1] = c3 & kLow;
  }
}

// sqrt(-2 ln u) at u = (word + 1/2) / 2^32. With u = 2^e m and sqrt(1/2) <= m < sqrt(2),
// ln m = 2 artanh(s) for s = (m - 1) / (m + 1), |s| < 0.172.
[[gnu::always_inline]] inline double radius_of(std::uint64_t word) noexcept {
  const double u = (to_double(word) + 0.5) * 0x1.0p-32;
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
  return std::sqrt(-2.0 * (e * std::numbers::ln2 + log_m));
}

struct Direction {
  double cosine, sine;
};

// An angle that is uniform on the circle: the upper two bits choose the
// quadrant, the rest an angle a in (-pi/4, pi/4) about its axis.
[[gnu::always_inline]] inline Direction direction_of(std::uint64_t word) noexcept {
  const double a = (to_double(word & 0x3FFFFFFFu) + (0.5 - 0x1.0p29)) * (0.5 * std::numbers::pi * 0x1.0p-30);
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
  const std::uint64_t quarter = (word >> 30) & 1u;
  const std::uint64_t half = word >> 31;
  const std::uint64_t swap = std::uint64_t{0} - quarter;
  const std::uint64_t bits_c = std::bit_cast<std::uint64_t>(c);
  const std::uint64_t bits_s = std::bit_cast<std::uint64_t>(s);
  const std::uint64_t exchange = (bits_c ^ bits_s) & swap;
  return {std::bit_cast<double>((bits_c ^ exchange) ^ ((quarter ^ half) << 63)),
          std::bit_cast<double>((bits_s ^ exchange) ^ (half << 63))};
}

KITH_VECTOR_CLONES void transform(const std::uint64_t* radius_words, const std::uint64_t* angle_words, double* cosine,
                                  double* sine) noexcept {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double radius = radius_of(radius_words[i]);
    const Direction direction = direction_of(angle_words[i]);
    cosine[i] = radius * direction.cosine;
    sine[i] = radius * direction.sine;
  }
}

}  // namespace

NormalPairs::NormalPairs(RandomStream& random) noexcept : key_{random(), random()} {}

void NormalPairs::fill(std::uint64_t block, Block& cosine, Block& sine) const noexcept {
  std::array<std::uint64_t, kBlock> radius_words;
  std::array<std::uint64_t, kBlock> angle_words;
  fill_words(block * (kBlock / 2), key_[0], key_[1], radius_words.data(), angle_words.data());
  transform(radius_words.data(), angle_words.data(), cosine.data(), sine.data());
}

void batch_standard_normal(std::span<double> out, RandomStream& random) noexcept {
  const NormalPairs normal{random};
  const std::span<double> first = out.first((out.size() + 1) / 2);
  const std::span<double> second = out.subspan(first.size());
  NormalPairs::Block cosine;
  NormalPairs::Block sine;
  for (std::size_t begin = 0; begin < first.size(); begin += kBlock) {
    normal.fill(begin / kBlock, cosine, sine);
    std::copy_n(cosine.begin(), std::min(kBlock, first.size() - begin),
                first.begin() + static_cast<std::ptrdiff_t>(begin));
    if (begin >= second.size()) break;
    std::copy_n(sine.begin(), std::min(kBlock, second.size() - begin),
                second.begin() + static_cast<std::ptrdiff_t>(begin));
  }
}

}  // namespace kith
