#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/distributions.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::testing {

/// A half-space with a random integer normal, entries in [-limit, limit].
inline HalfSpace random_half_space(RandomStream& random, std::int64_t limit = 5) {
  for (;;) {
    IntegerVector normal(3);
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] = static_cast<std::int64_t>(uniform_index(static_cast<std::size_t>(2 * limit + 1), random)) - limit;
    }
    if (!normal.is_zero()) return HalfSpace{normal};
  }
}

inline std::vector<HalfSpace> random_list(std::size_t n, RandomStream& random, std::int64_t limit = 5) {
  std::vector<HalfSpace> list;
  for (std::size_t i = 0; i < n; ++i) list.push_back(random_half_space(random, limit));
  return list;
}

/// The prior of the studies: the step weight is negative.
inline Cone lower_hemisphere() { return Cone{}.clipped(HalfSpace{{0, 0, -1}}).value(); }

/// Beliefs that never resample.
inline constexpr FilterOptions kWeighOnly{.particles = 1000, .process_noise = 0.0, .resample_below = 0.0};

inline double total(std::span<const double> weights) { return std::accumulate(weights.begin(), weights.end(), 0.0); }

}  // namespace kith::testing
