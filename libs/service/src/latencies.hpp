#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kith/service/rehearsal.hpp"

namespace kith {

/// The summary of times in milliseconds; percentiles are observed values (nearest rank).
[[nodiscard]] inline LatencySummary summarised(std::vector<double> times) {
  if (times.empty()) return {};
  std::sort(times.begin(), times.end());
  const auto rank = [&](double p) {
    const auto at = static_cast<std::size_t>(std::ceil(p * static_cast<double>(times.size())));
    return times[std::max<std::size_t>(at, 1) - 1];
  };
  return {.count = times.size(), .p50 = rank(0.5), .p95 = rank(0.95), .p99 = rank(0.99), .max = times.back()};
}

}  // namespace kith
