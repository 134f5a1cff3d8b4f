#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/stats/factor.hpp"

namespace kith::detail {

// The observations that share the levels of all factors. A model of counts with a log link needs no more of them.
struct CountCell {
  std::vector<std::size_t> levels;  // one per factor
  double observations = 0.0;
  double sum = 0.0;
  double squares = 0.0;  // sum of squared deviations from the cell's mean
};

// How often a count occurs in all.
struct CountFrequency {
  double count = 0.0;
  double observations = 0.0;
};

struct CountData {
  std::vector<CountCell> cells;             // those with observations, in the order of first appearance
  std::vector<CountFrequency> frequencies;  // ascending
  double observations = 0.0;
  double sum = 0.0;
  double log_factorials = 0.0;  // sum of log(y!)
};

// Factors have one code per count and no unused levels.
[[nodiscard]] CountData summarise_counts(std::span<const double> counts, std::span<const Factor> factors);

}  // namespace kith::detail
