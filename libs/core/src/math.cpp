#include "kith/core/math.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

// Series of Taylor, long enough for arguments that were reduced first. Their terms are added in small groups, which a
// processor can compute side by side.
namespace kith::math {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLn2High = 0x1.62e42fee00000p-1;  // times a power of 2 of a double this is exact
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
constexpr std::uint64_t kFraction = 0xFFFFFFFFFFFFF;

// 2^k, |k| <= 1022.
double power_of_2(std::int64_t k) { return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52); }

// e^x - 1 = 2^k (1 + first + rest) - 1, where |first| <= ln(2) / 2.
struct Exponential {
  std::int64_t k;
  double first, rest;
};

Exponential exponential(double x) {
  const double shifted = x * std::numbers::log2e + kRound;
  const double k = shifted - kRound;
  const double high = x - k * kLn2High;
  const double low = k * kLn2Low;
  const double r = high - low;
  const double q = r * r;
  const double a = (1.0 / 2 + r * (1.0 / 6)) + q * (1.0 / 24 + r * (1.0 / 120));
  const double b = (1.0 / 720 + r * (1.0 / 5040)) + q * (1.0 / 40320 + r * (1.0 / 362880));
  const double c = (1.0 / 3628800 + r * (1.0 / 39916800)) + q * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const auto bits = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(shifted));
  return {static_cast<std::int32_t>(bits), r, ((high - r) - low) + q * (a + (q * q) * (b + (q * q) * c))};
}

// log(2^k (1 + f)), where 1 + f lies between the roots of 1/2 and 2: by 2 artanh(s), s = f / (2 + f), which is
// f - f^2 / 2 + s (f^2 / 2 + r) with r = 2 s^2 / 3 + 2 s^4 / 5 + ...
double logarithm(double k, double f) {
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double a = (2.0 / 3 + z * (2.0 / 5)) + w * (2.0 / 7 + z * (2.0 / 9));
  const double b = (2.0 / 11 + z * (2.0 / 13)) + w * (2.0 / 15 + z * (2.0 / 17));
  const double r = z * (a + (w * w) * (b + (w * w) * (2.0 / 19 + z * (2.0 / 21))));
  const double half = 0.5 * f * f;
  return k * kLn2High - ((half - (s * (half + r) + k * kLn2Low)) - f);
}

// x less the nearest multiple of a right angle, as a sum, and the number of right angles.
struct Reduced {
  double r, rest;
  unsigned quarters;
};

Reduced reduced(double x) {
  constexpr double kFirst = 0x1.921fb544p0;  // pi / 2 in three parts: products with the first two are exact
  constexpr double kSecond = 0x1.0b4611a6p-34;
  constexpr double kThird = 0x1.3198a2e037073p-69;
  const double shifted = x * (2.0 / std::numbers::pi) + kRound;
  const double n = shifted - kRound;
  const double a = x - n * kFirst;
  const double b = a - n * kSecond;
  const double low = n * kThird - ((a - b) - n * kSecond);
  const double r = b - low;
  return {r, (b - r) - low, static_cast<unsigned>(std::bit_cast<std::uint64_t>(shifted) & 3)};
}

// The sine or the cosine of r + rest, within an eighth of a turn.
double sine(double r, double rest) {
  const double q = r * r;
  const double w = q * q;
  const double a = (1.0 / 120 - q * (1.0 / 5040)) + w * (1.0 / 362880 - q * (1.0 / 39916800));
  const double b = (1.0 / 6227020800 - q * (1.0 / 1307674368000)) + w * (1.0 / 355687428096000);
  const double cube = q * r;
  return r - ((q * (0.5 * rest - cube * (a + (w * w) * b)) - rest) + cube * (1.0 / 6));
}

double cosine(double r, double rest) {
  const double q = r * r;
  const double w = q * q;
  const double a = (1.0 / 24 - q * (1.0 / 720)) + w * (1.0 / 40320 - q * (1.0 / 3628800));
  const double b = (1.0 / 479001600 - q * (1.0 / 87178291200)) + w * (1.0 / 20922789888000);
  const double first = 1.0 - 0.5 * q;
  return first + (((1.0 - first) - 0.5 * q) + (w * (a + (w * w) * b) - r * rest));
}

}  // namespace

double exp(double x) noexcept {
  constexpr double kMost = 800.0;  // infinity, or 0 on the other side
  const auto [k, first, rest] = exponential(std::clamp(x, -kMost, kMost));
  const double sum = 1.0 + first;
  return (sum + ((first - (sum - 1.0)) + rest)) * power_of_2(k / 2) * power_of_2(k - k / 2);
}

double expm1(double x) noexcept {
  if (!(std::abs(x) < 0.5 * std::numbers::ln2)) return exp(x) - 1.0;
  const auto parts = exponential(x);
  return parts.first + parts.rest;
}

double log(double x) noexcept {
  if (!(x > 0.0 && x < kInfinity))
    return x == 0.0 ? -kInfinity : x > 0.0 ? x : std::numeric_limits<double>::quiet_NaN();
  if (x < std::numeric_limits<double>::min()) return log(x * 0x1p54) - 54.0 * std::numbers::ln2;
  constexpr auto kRootOfHalf = std::bit_cast<std::uint64_t>(0.5 * std::numbers::sqrt2);
  // Less the bits of the root, the exponent counts from there.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) - kRootOfHalf;
  const auto k = static_cast<std::int64_t>(bits) >> 52;
  return logarithm(static_cast<double>(k), std::bit_cast<double>((bits & kFraction) + kRootOfHalf) - 1.0);
}

double log1p(double x) noexcept {
  constexpr double kNear = 0.29;
  return std::abs(x) < kNear ? logarithm(0.0, x) : log(1.0 + x);
}

double pow(double x, double y) noexcept { return exp(y * log(x)); }

double sin(double x) noexcept {
  const auto [r, rest, quarters] = reduced(x);
  const double value = (quarters & 1) != 0 ? cosine(r, rest) : sine(r, rest);
  return (quarters & 2) != 0 ? -value : value;
}

double cos(double x) noexcept {
  const auto [r, rest, quarters] = reduced(x);
  const double value = (quarters & 1) != 0 ? sine(r, rest) : cosine(r, rest);
  return ((quarters + 1) & 2) != 0 ? -value : value;
}

// In the first eighth of a turn the angle of n / 4 and, by the difference of two tangents, what remains to it.
double atan2(double y, double x) noexcept {
  // Those of 0, 1/4, 1/2, 3/4 and 1, as sums.
  constexpr std::array kHigh{0.0, 0x1.f5b75f92c80ddp-3, 0x1.dac670561bb4fp-2, 0x1.4978fa3269ee1p-1,
                             0.25 * std::numbers::pi};
  constexpr double kPiLow = 0x1.1a62633145c07p-53;
  constexpr std::array kLow{0.0, 0x1.8ab6e3cf7afbdp-57, 0x1.a2b7f222f65e2p-56, 0x1.2419a87f2a458p-56, 0.25 * kPiLow};
  const double large = std::max(std::abs(x), std::abs(y));
  const double small = std::min(std::abs(x), std::abs(y));
  const auto n = static_cast<std::size_t>(large > 0.0 ? 4.0 * (small / large) + 0.5 : 0.0);
  const double tangent = 0.25 * static_cast<double>(n);
  double u = large > 0.0 ? (small - tangent * large) / (large + tangent * small) : 0.0;
  const double z = u * u;
  const double w = z * z;
  const double a = (1.0 / 3 - z * (1.0 / 5)) + w * (1.0 / 7 - z * (1.0 / 9));
  const double b = (1.0 / 11 - z * (1.0 / 13)) + w * (1.0 / 15 - z * (1.0 / 17));
  double high = kHigh[n];
  double low = kLow[n] - u * z * (a + (w * w) * b);
  const auto less_than = [&](double angle, double its_low) {
    high = angle - high;
    low = its_low - low;
    u = -u;
  };
  if (std::abs(y) > std::abs(x)) less_than(0.5 * std::numbers::pi, 0.5 * kPiLow);
  if (std::signbit(x)) less_than(std::numbers::pi, kPiLow);
  return std::copysign(high + (u + low), y);
}

double asin(double x) noexcept { return atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }

}  // namespace kith::math
