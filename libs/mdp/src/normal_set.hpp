#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace kith::detail {

// Of a normal, shape [d].
inline double dot_of(const double* normal, std::span<const double> weights) {
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += normal[k] * weights[k];
  return sum;
}

// Collects normals of d entries, each once: those that differ by less than `quantum` count as equal if the grid of that
// width does not part them.
class NormalSet {
 public:
  NormalSet(std::size_t dimension, double quantum, std::size_t most)
      : d_{dimension}, quantum_{quantum}, per_quantum_{1.0 / quantum} {
    std::size_t size = 16;
    while (size < 2 * most) size *= 2;
    slots_.assign(size, kFree);
  }

  // @returns whether it is a new one.
  bool insert(const double* normal) {
    std::uint64_t hash = 0xCBF29CE484222325ull;
    for (std::size_t k = 0; k < d_; ++k) {
      hash = (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(normal[k] * per_quantum_))) *
             0xFF51AFD7ED558CCDull;
      hash ^= hash >> 32;
    }
    for (std::size_t at = hash & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at] == kFree) {
        slots_[at] = static_cast<std::uint32_t>(normals_.size() / d_);
        for (std::size_t k = 0; k < d_; ++k) normals_.push_back(normal[k]);
        return true;
      }
      const double* const other = &normals_[slots_[at] * d_];
      bool is_equal = true;
      for (std::size_t k = 0; k < d_; ++k) is_equal = is_equal && std::abs(normal[k] - other[k]) <= quantum_;
      if (is_equal) return false;
    }
  }

  // Row-major, those that hold by least for these weights first: they are the first to fail elsewhere.
  [[nodiscard]] std::vector<double> by_margin(std::span<const double> weights) const {
    constexpr std::ptrdiff_t kMostSorted = 64;
    std::vector<std::pair<double, std::size_t>> order;
    order.reserve(normals_.size() / d_);
    for (std::size_t i = 0; i < normals_.size(); i += d_) order.emplace_back(dot_of(&normals_[i], weights), i);
    const auto last = order.begin() + std::min(kMostSorted, std::ssize(order));
    std::partial_sort(order.begin(), last, order.end());
    std::vector<double> sorted;
    sorted.reserve(normals_.size());
    for (const auto& [margin, i] : order)
      for (std::size_t k = 0; k < d_; ++k) sorted.push_back(normals_[i + k]);
    return sorted;
  }

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFFu;
  std::size_t d_;
  double quantum_, per_quantum_;
  std::vector<std::uint32_t> slots_;
  std::vector<double> normals_;
};

}  // namespace kith::detail
