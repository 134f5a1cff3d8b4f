#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kith {

/// The distribution of a sum of two independent counts, each from 0.
[[nodiscard]] inline std::vector<double> convolved(std::span<const double> a, std::span<const double> b) {
  std::vector<double> sum(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) sum[i + j] += a[i] * b[j];
  }
  return sum;
}

}  // namespace kith
