#pragma once

namespace kith {

/// Sine and cosine in single precision, for loops that a compiler can vectorise.
struct SineCosine {
  float sine, cosine;
};

/// Those of an angle in [-pi/4, pi/4] radians, by the Chebyshev interpolants of sin a / a and cos a in a^2: errors 4e-9
/// and 4e-8 before rounding. No error is reported beyond that range; the values are wrong there.
[[gnu::always_inline]] inline SineCosine sine_cosine_in_eighth_turn(float a) noexcept {
  const float q = a * a;
  float s = -0.00019503904f;
  s = s * q + 0.0083320358f;
  s = s * q - 0.16666651f;
  s = a + a * q * s;
  float c = -0.0013585779f;
  c = c * q + 0.041655015f;
  c = c * q - 0.49999857f;
  c = c * q + 1.0f;
  return {s, c};
}

}  // namespace kith
