#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cell_model.hpp"
#include "f_test.hpp"

namespace kith::detail {

// Size, mean and spread of the values of one group.
struct Sample {
  double n = 0.0;
  double mean = 0.0;
  double sum_of_squares = 0.0;  // around the mean
  [[nodiscard]] double variance() const { return sum_of_squares / (n - 1.0); }
};

// There is at least one value.
inline Sample describe(std::span<const double> values) {
  Sample sample{static_cast<double>(values.size())};
  const double origin = values.front();  // Equal values have exactly no spread.
  for (const double value : values) sample.mean += value - origin;
  sample.mean = origin + sample.mean / sample.n;
  for (const double value : values) sample.sum_of_squares += (value - sample.mean) * (value - sample.mean);
  return sample;
}

inline bool no_spread(double sum_of_squares, double n, double rounding) {
  return sum_of_squares <= negligible_sum_of_squares(rounding, static_cast<std::size_t>(n));
}

// Two samples in the same standardised units. Each has at least one value.
struct TwoSamples {
  Sample first;
  Sample second;
  double rounding = 0.0;
  int exponent = 0;
  [[nodiscard]] double n() const { return first.n + second.n; }
  [[nodiscard]] double within() const { return first.sum_of_squares + second.sum_of_squares; }
};

inline TwoSamples describe(std::span<const double> a, std::span<const double> b) {
  std::vector<double> both{a.begin(), a.end()};
  both.insert(both.end(), b.begin(), b.end());
  const auto standardized = standardize(both);
  const std::span<const double> values{standardized.values};
  return {describe(values.first(a.size())), describe(values.subspan(a.size())), standardized.rounding,
          standardized.exponent};
}

}  // namespace kith::detail
