#include "kith/core/distributions.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "kith/core/math.hpp"

namespace kith {
namespace {

__extension__ using UInt128 = unsigned __int128;

struct NormalPair {
  double cosine, sine;
};

// Box & Muller (1958). 1 - u lies in (0, 1], so the logarithm is finite.
NormalPair normal_pair(RandomStream& random) noexcept {
  const double radius = std::sqrt(-2.0 * math::log(1.0 - uniform01(random)));
  const double angle = 2.0 * std::numbers::pi * uniform01(random);
  return {radius * math::cos(angle), radius * math::sin(angle)};
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

}  // namespace kith
