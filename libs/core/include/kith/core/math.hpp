#pragma once

/// Functions whose bits are the same on every processor and with every C library, which those of <cmath> are not: glibc
/// uses fused multiply-add where the processor has it, and others round in other ways. These consist of additions,
/// multiplications, divisions and std::sqrt, which IEEE 754 defines. What a result depends on uses nothing else. Errors
/// are in units in the last place of the result.
namespace kith::math {

/// Error below 0.7; below 1 where it is denormal.
[[nodiscard]] double exp(double x) noexcept;
/// exp(x) - 1, with its digits near 0: error below 3.
[[nodiscard]] double expm1(double x) noexcept;
/// Error below 0.9. -infinity at 0, NaN below.
[[nodiscard]] double log(double x) noexcept;
/// log(1 + x), with its digits near 0: error below 3.
[[nodiscard]] double log1p(double x) noexcept;
/// exp(y log(x)), 0 <= x: error below 1 + 3 |y log(x)|. NaN where x and y are 0.
[[nodiscard]] double pow(double x, double y) noexcept;

/// Error below 0.8 for |x| <= 1e5, beyond which there are no digits left.
[[nodiscard]] double sin(double x) noexcept;
[[nodiscard]] double cos(double x) noexcept;
/// The angle of the point (x, y), both finite, in [-pi, pi]: error below 1.5.
[[nodiscard]] double atan2(double y, double x) noexcept;
/// |x| <= 1: error below 3.
[[nodiscard]] double asin(double x) noexcept;

}  // namespace kith::math
