#include "kith/random/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace kith {
namespace {

__extension__ using UInt128 = unsigned __int128;

struct NormalPair {
  double cosine, sine;
};

// Box & Muller (1958). 1 - u lies in (0, 1], so the logarithm is finite.
NormalPair normal_pair(RandomStream& random) noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform01(random)));
  const double angle = 2.0 * std::numbers::pi * uniform01(random);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// x cos(angle) u + x sin(angle) v + z n for a right-handed frame (u, v, n), by
// the branchless construction of Duff et al. (2017).
std::array<double, 3> around(std::span<const double, 3> n, double z, double radius, double angle) noexcept {
  const double sign = std::copysign(1.0, n[2]);
  const double a = -1.0 / (sign + n[2]);
  const double b = n[0] * n[1] * a;
  const std::array u{1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
  const std::array v{b, sign + n[1] * n[1] * a, -n[1]};
  const double x = radius * std::cos(angle);
  const double y = radius * std::sin(angle);
  return {x * u[0] + y * v[0] + z * n[0], x * u[1] + y * v[1] + z * n[1], x * u[2] + y * v[2] + z * n[2]};
}

std::size_t wide_index(std::uint64_t n, RandomStream& random) {
  const std::uint64_t threshold = (std::uint64_t{0} - n) % n;
  for (;;) {
    const std::uint64_t upper = random();
    const UInt128 product = static_cast<UInt128>((upper << 32) | random()) * n;
    if (static_cast<std::uint64_t>(product) >= threshold) return static_cast<std::size_t>(product >> 64);
  }
}

}  // namespace

std::size_t uniform_index(std::size_t n, RandomStream& random) {
  if (n == 0) throw std::invalid_argument{"uniform_index: there must be something to choose from"};
  if (n > std::numeric_limits<std::uint32_t>::max()) return wide_index(n, random);
  const std::uint64_t threshold = ((std::uint64_t{1} << 32) - n) % n;
  for (;;) {
    const std::uint64_t product = std::uint64_t{random()} * n;
    if ((product & 0xFFFFFFFFu) >= threshold) return static_cast<std::size_t>(product >> 32);
  }
}

double standard_normal(RandomStream& random) noexcept { return normal_pair(random).cosine; }

void fill_standard_normal(std::span<double> out, RandomStream& random) noexcept {
  for (std::size_t i = 0; i < out.size(); i += 2) {
    const NormalPair pair = normal_pair(random);
    out[i] = pair.cosine;
    if (i + 1 < out.size()) out[i + 1] = pair.sine;
  }
}

double half_normal(double sigma, RandomStream& random) {
  if (!(sigma >= 0.0) || !std::isfinite(sigma)) {
    throw std::invalid_argument{"half_normal: sigma must be at least 0 and finite, not " + std::to_string(sigma)};
  }
  return std::abs(sigma * standard_normal(random));
}

std::size_t categorical(std::span<const double> weights, RandomStream& random) {
  double sum = 0.0;
  std::size_t last_possible = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] >= 0.0)) throw std::invalid_argument{"categorical: every weight must be at least 0"};
    if (weights[i] > 0.0) last_possible = i;
    sum += weights[i];
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    throw std::invalid_argument{"categorical: the weights must have a positive, finite sum"};
  }
  double left = uniform01(random) * sum;
  for (std::size_t i = 0; i < last_possible; ++i) {
    if (left < weights[i]) return i;
    left -= weights[i];
  }
  return last_possible;  // also where rounding leaves a little over
}

std::array<double, 3> uniform_on_sphere(RandomStream& random) noexcept {
  const double u = uniform01(random);
  const double angle = 2.0 * std::numbers::pi * uniform01(random);
  const double radius = 2.0 * std::sqrt(u * (1.0 - u));
  return {radius * std::cos(angle), radius * std::sin(angle), 1.0 - 2.0 * u};
}

std::array<double, 3> von_mises_fisher(std::span<const double, 3> mean, double kappa, RandomStream& random) {
  if (!(kappa >= 0.0) || !std::isfinite(kappa)) {
    throw std::invalid_argument{"von_mises_fisher: kappa must be at least 0 and finite, not " + std::to_string(kappa)};
  }
  const double u = uniform01(random);
  const double angle = 2.0 * std::numbers::pi * uniform01(random);
  // depth = 1 - cosine in [0, 2]; kept apart because 1 - cosine^2 would cancel for large kappa.
  const double depth = std::clamp(kappa > 0.0 ? -std::log1p(u * std::expm1(-2.0 * kappa)) / kappa : 2.0 * u, 0.0, 2.0);
  return around(mean, 1.0 - depth, std::sqrt(depth * (2.0 - depth)), angle);
}

}  // namespace kith
