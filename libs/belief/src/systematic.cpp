#include "systematic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kith/belief/particle_belief.hpp"

namespace kith {
namespace detail {

std::vector<std::uint32_t> systematic_ends(std::span<const double> weights, std::size_t n, double u) {
  if (!(u >= 0.0 && u < 1.0)) throw std::invalid_argument("systematic_counts: the offset must lie in [0, 1)");
  if (n > std::numeric_limits<std::int32_t>::max()) throw std::invalid_argument("systematic_counts: too many draws");
  std::vector<double> cumulative(weights.size());
  double sum = 0.0;
  std::size_t last = 0;
  bool negative = false;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    negative |= weights[i] < 0.0;
    sum += weights[i];
    cumulative[i] = sum;
    last = weights[i] > 0.0 ? i : last;
  }
  if (negative || !(sum > 0.0 && std::isfinite(sum))) {
    throw std::invalid_argument("systematic_counts: the weights must be >= 0 with a positive, finite sum");
  }
  const auto count = static_cast<double>(n);
  const double scale = count / sum;
  std::vector<std::uint32_t> ends(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    // k + u < n C has ceil(n C - u) solutions k >= 0.
    const double below = std::ceil(cumulative[i] * scale - u);
    ends[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(below < count ? below : count));
  }
  std::fill(ends.begin() + static_cast<std::ptrdiff_t>(last), ends.end(), static_cast<std::uint32_t>(n));
  return ends;
}

std::vector<std::uint32_t> systematic_indices(std::span<const double> weights, std::size_t n, double u) {
  const std::vector<std::uint32_t> ends = systematic_ends(weights, n, u);
  // Each index is written where its draws begin; of several that begin at one
  // place only the last has draws. A running maximum fills the rest.
  std::vector<std::uint32_t> index(n + 1, 0);
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    index[begin] = static_cast<std::uint32_t>(i);
    begin = ends[i];
  }
  index.pop_back();
  for (std::size_t k = 1; k < n; ++k) index[k] = std::max(index[k], index[k - 1]);
  return index;
}

}  // namespace detail

std::vector<std::size_t> systematic_counts(std::span<const double> weights, std::size_t n, double u) {
  const std::vector<std::uint32_t> ends = detail::systematic_ends(weights, n, u);
  std::vector<std::size_t> counts(ends.size());
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    counts[i] = ends[i] - begin;
    begin = ends[i];
  }
  return counts;
}

}  // namespace kith
