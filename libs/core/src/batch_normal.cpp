#include "kith/core/batch_normal.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "kith/core/eighth_turn.hpp"
#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

constexpr std::size_t kBlock = NormalPairs::kBlock;  // all of it stays in the first-level cache

// 32 bits for each pair of a block.
using Words = std::array<std::uint32_t, kBlock>;
constexpr std::size_t kHalf = kBlock / 2;

// One round of Threefry: both pairs are mixed by addition, rotation and exclusive or.
template <int first, int second>
[[gnu::always_inline]] inline void mix(std::uint32_t& a, std::uint32_t& b, std::uint32_t& c,
                                       std::uint32_t& d) noexcept {
  a += b;
  b = std::rotl(b, first) ^ a;
  c += d;
  d = std::rotl(d, second) ^ c;
}

// Threefry4x32-20 of the counters first, first + 1, ...: 32 bits for the radius and 32 for the angle of
// kBlock pairs; each counter serves two, kHalf apart. `first` is a multiple of kHalf, so only its lowest bits
// count on. No multiplication: what multiplies 32 bits to 64 in a vector is slow or hard to reach from plain loops.
KITH_VECTOR_CLONES void fill_words(std::uint64_t first, std::uint32_t key0, std::uint32_t key1, std::uint32_t* radius,
                                   std::uint32_t* angle) noexcept {
  const auto low = static_cast<std::uint32_t>(first);
  const auto high = static_cast<std::uint32_t>(first >> 32);
  const std::array<std::uint32_t, 5> key{key0, key1, 0, 0, 0x1BD11BDAu ^ key0 ^ key1};
  KITH_INDEPENDENT_LOOP
  for (std::uint32_t i = 0; i < kHalf; ++i) {
    std::uint32_t a = low + i + key[0];
    std::uint32_t b = high + key[1];
    std::uint32_t c = key[2];
    std::uint32_t d = key[3];
    const auto add_key = [&](std::uint32_t n) {
      a += key[n % 5];
      b += key[(n + 1) % 5];
      c += key[(n + 2) % 5];
      d += key[(n + 3) % 5] + n;
    };
    const auto four_rounds = [&] {
      mix<10, 26>(a, b, c, d);
      mix<11, 21>(a, d, c, b);
      mix<13, 27>(a, b, c, d);
      mix<23, 5>(a, d, c, b);
    };
    const auto four_other_rounds = [&] {
      mix<6, 20>(a, b, c, d);
      mix<17, 11>(a, d, c, b);
      mix<25, 10>(a, b, c, d);
      mix<18, 20>(a, d, c, b);
    };
    four_rounds();
    add_key(1);
    four_other_rounds();
    add_key(2);
    four_rounds();
    add_key(3);
    four_other_rounds();
    add_key(4);
    four_rounds();
    add_key(5);
    radius[i] = a;
    angle[i] = b;
    radius[kHalf + i] = c;
    angle[kHalf + i] = d;
  }
}

// Signed, because there is no conversion of unsigned integers in the baseline instruction set.
[[gnu::always_inline]] inline float to_float(std::uint32_t n) noexcept {
  return static_cast<float>(std::bit_cast<std::int32_t>(n));
}

// An arithmetic shift by n keeps the sign.
template <int n>
[[gnu::always_inline]] inline std::uint32_t shifted_signed(std::uint32_t bits) noexcept {
  return std::bit_cast<std::uint32_t>(std::bit_cast<std::int32_t>(bits) >> n);
}

// sqrt(-2 ln u) at u = (word's upper 31 bits + 1/2) / 2^31. With u = 2^e m and sqrt(1/2) <= m < sqrt(2),
// ln m = 2 artanh(s) for s = (m - 1) / (m + 1), |s| < 0.172: the Chebyshev interpolant of 2 artanh(s) / s
// in s^2, relative error 7e-10 before rounding. Where e is 0, m - 1 comes from the complement of the bits:
// so a small radius is as accurate as a large one.
[[gnu::always_inline]] inline float radius_of(std::uint32_t word) noexcept {
  const float u = to_float(word >> 1) * 0x1.0p-31f + 0x1.0p-32f;
  // Subtracting the bits of sqrt(1/2) makes the exponent field count from there.
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(u) - 0x3F3504F3u;
  const float m = std::bit_cast<float>((bits & 0x007FFFFFu) + 0x3F3504F3u);
  const float e = to_float(shifted_signed<23>(bits));
  const float below_one = to_float(~word >> 1) * -0x1.0p-31f - 0x1.0p-32f;
  const float f = e == 0.0f ? below_one : m - 1.0f;
  const float s = f / (f + 2.0f);
  const float q = s * s;
  float p = 0.29924996f;
  p = p * q + 0.39974828f;
  p = p * q + 0.66666816f;
  p = p * q + 2.0f;
  return std::sqrt(-2.0f * (e * std::numbers::ln2_v<float> + s * p));
}

struct Direction {
  float cosine, sine;
};

// An angle that is uniform on the circle: the upper two bits choose the
// quadrant, the rest an angle a in [-pi/4, pi/4) about its axis.
[[gnu::always_inline]] inline Direction direction_of(std::uint32_t word) noexcept {
  const float a = to_float((word << 2) ^ 0x80000000u) * (0.25f * std::numbers::pi_v<float> * 0x1.0p-31f);
  const auto [s, c] = sine_cosine_in_eighth_turn(a);
  // A quarter turn maps (c, s) to (-s, c), a half turn negates both: swap on
  // bit 30, then flip signs, all on the bit patterns so that nothing branches.
  constexpr std::uint32_t kSign = 0x80000000u;
  const std::uint32_t swap = shifted_signed<31>(word << 1);
  const std::uint32_t bits_c = std::bit_cast<std::uint32_t>(c);
  const std::uint32_t bits_s = std::bit_cast<std::uint32_t>(s);
  const std::uint32_t exchange = (bits_c ^ bits_s) & swap;
  return {std::bit_cast<float>((bits_c ^ exchange) ^ (((word << 1) ^ word) & kSign)),
          std::bit_cast<float>((bits_s ^ exchange) ^ (word & kSign))};
}

KITH_VECTOR_CLONES void transform(const std::uint32_t* radius_words, const std::uint32_t* angle_words, float* cosine,
                                  float* sine) noexcept {
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float radius = radius_of(radius_words[i]);
    const Direction direction = direction_of(angle_words[i]);
    cosine[i] = radius * direction.cosine;
    sine[i] = radius * direction.sine;
  }
}

}  // namespace

NormalPairs::NormalPairs(RandomStream& random) noexcept : key_{random(), random()} {}

void NormalPairs::fill(std::uint64_t block, Block& cosine, Block& sine) const noexcept {
  Words radius;
  Words angle;
  fill_words(block * kHalf, key_[0], key_[1], radius.data(), angle.data());
  transform(radius.data(), angle.data(), cosine.data(), sine.data());
}

WordPairs::WordPairs(RandomStream& random) noexcept : key_{random(), random()} {}

void WordPairs::fill(std::uint64_t block, Block& first, Block& second) const noexcept {
  fill_words(block * kHalf, key_[0], key_[1], first.data(), second.data());
}

}  // namespace kith
