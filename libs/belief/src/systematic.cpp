#include "systematic.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kith/belief/particle_belief.hpp"
#include "kith/core/vector_clones.hpp"
#include "scratch.hpp"

namespace kith {
namespace detail {
namespace {

// k + u < scale C has ceil(scale C - u) solutions k >= 0, of which `most` count.
KITH_VECTOR_CLONES void count_below(std::span<const double> cumulative, double scale, double u, double most,
                                    std::span<std::uint32_t> ends) {
  const double* const c = cumulative.data();
  std::uint32_t* const out = ends.data();
  for (std::size_t i = 0; i < cumulative.size(); ++i) {
    const double below = std::ceil(c[i] * scale - u);
    out[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(below < most ? below : most));
  }
}

// below[i] = weights[0] + ... + weights[i], four at a time to shorten the chain of
// additions; returns the sum. On its own, so that the running sum stays in a register.
[[gnu::noinline]] double cumulate(std::span<const double> weights, std::span<double> below) {
  const double* const w = weights.data();
  double* const out = below.data();
  double sum = 0.0;
  std::size_t i = 0;
  for (; i + 4 <= weights.size(); i += 4) {
    const double two = w[i] + w[i + 1];
    const double three = two + w[i + 2];
    const double four = two + (w[i + 2] + w[i + 3]);
    out[i] = sum + w[i];
    out[i + 1] = sum + two;
    out[i + 2] = sum + three;
    out[i + 3] = sum = sum + four;
  }
  for (; i < weights.size(); ++i) out[i] = sum += w[i];
  return sum;
}

// Whether some weight is below zero; -0 is not.
KITH_VECTOR_CLONES bool has_negative(std::span<const double> weights) {
  const double* const w = weights.data();
  std::uint64_t signs = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) signs |= std::bit_cast<std::uint64_t>(w[i]);
  return (signs >> 63) != 0 && std::any_of(weights.begin(), weights.end(), [](double x) { return x < 0.0; });
}

// Many draws of one index, beyond the first kIndexRoom.
[[gnu::noinline]] void repeat_rest(std::uint32_t i, std::uint32_t* first, std::uint32_t* last) {
  std::fill(first, last, i);
}

// Writes each i from its begin to its end and a little beyond, which the next ones overwrite: without
// a branch that depends on the counts, unless there are more than kIndexRoom.
KITH_VECTOR_CLONES void repeat_indices(std::span<const std::uint32_t> ends, std::uint32_t* index) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::size_t end = ends[i];
    for (std::size_t k = 0; k < kIndexRoom; ++k) index[begin + k] = static_cast<std::uint32_t>(i);
    if (end - begin > kIndexRoom) [[unlikely]] {
      repeat_rest(static_cast<std::uint32_t>(i), index + begin + kIndexRoom, index + end);
    }
    begin = end;
  }
}

}  // namespace

void systematic_ends(std::span<const double> weights, std::size_t n, double u, std::span<std::uint32_t> ends) {
  if (!(u >= 0.0 && u < 1.0)) throw std::invalid_argument("systematic_counts: the offset must lie in [0, 1)");
  if (n > std::numeric_limits<std::int32_t>::max()) throw std::invalid_argument("systematic_counts: too many draws");
  ParticleScratch<double> cumulative{weights.size()};
  const double sum = cumulate(weights, cumulative.values());
  if (has_negative(weights) || !(sum > 0.0 && std::isfinite(sum))) {
    throw std::invalid_argument("systematic_counts: the weights must be >= 0 with a positive, finite sum");
  }
  std::size_t last = weights.size() - 1;
  while (weights[last] == 0.0) --last;
  count_below(cumulative.values(), static_cast<double>(n) / sum, u, static_cast<double>(n), ends);
  std::fill(ends.begin() + static_cast<std::ptrdiff_t>(last), ends.end(), static_cast<std::uint32_t>(n));
}

void systematic_indices(std::span<const double> weights, double u, std::span<std::uint32_t> index) {
  ParticleScratch<std::uint32_t> ends{weights.size()};
  systematic_ends(weights, index.size() - kIndexRoom, u, ends.values());
  repeat_indices(ends.values(), index.data());
}

}  // namespace detail

std::vector<std::size_t> systematic_counts(std::span<const double> weights, std::size_t n, double u) {
  detail::ParticleScratch<std::uint32_t> scratch{weights.size()};
  const std::span<std::uint32_t> ends = scratch.values();
  detail::systematic_ends(weights, n, u, ends);
  std::vector<std::size_t> counts(ends.size());
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    counts[i] = ends[i] - begin;
    begin = ends[i];
  }
  return counts;
}

}  // namespace kith
