#include "kith/runs/arithmetic.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"

namespace kith {
namespace {

// Every function that results depend on, at `x` in (0, 1).
void probe(ByteWriter& bits, double x) {
  const double wide = 40.0 * (x - 0.5), angle = 2.0 * std::numbers::pi * x;
  int sign = 0;  // lgamma() would write it to a variable that all threads share
  for (const double value :
       {std::exp(wide), std::expm1(wide), std::log(x), std::log1p(x), std::sin(angle), std::cos(angle), std::tan(x),
        std::acos(2.0 * x - 1.0), std::asin(2.0 * x - 1.0), std::atan2(x, 1.0 - x), std::pow(x, 1.7), std::tanh(wide),
        std::erf(wide), std::erfc(wide), ::lgamma_r(5.0 * x, &sign), std::hypot(x, wide), std::cbrt(wide)})
    bits.real(value);
  const auto single = static_cast<float>(x);
  const auto single_angle = static_cast<float>(angle);
  for (const float value : {std::exp(single), std::log(single), std::sin(single_angle), std::cos(single_angle)})
    bits.real(static_cast<double>(value));
}

}  // namespace

std::string math_library() {
#ifdef __GLIBC__
  return std::string{"glibc "} + gnu_get_libc_version();
#else
  return "unknown";
#endif
}

std::string arithmetic_fingerprint() {
  constexpr std::size_t kPoints = 500;
  constexpr std::size_t kDigits = 16;
  ByteWriter bits;
  for (std::size_t i = 0; i < kPoints; ++i) {
    // The golden ratio spreads any number of points evenly.
    const double x = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
    probe(bits, x);
  }
  return sha256(bits.bytes()).substr(0, kDigits);
}

}  // namespace kith
