#pragma once

#include <optional>
#include <span>

namespace kith {

/// The arithmetic mean. @throws std::invalid_argument without values.
[[nodiscard]] double mean(std::span<const double> values);

/// The sample standard deviation (n - 1), in two passes, so that nothing cancels; missing below two values.
[[nodiscard]] std::optional<double> standard_deviation(std::span<const double> values);

/// The jackknife standard error of a statistic, sqrt((n - 1) / n sum_i (x_i - mean)^2), from its values x_i
/// without the i-th of n independent parts of the data. @throws std::invalid_argument without values.
[[nodiscard]] double jackknife_error(std::span<const double> without);

/// Number, sum and sum of squares of values, from which values can be taken away again. Add values less a constant near
/// their mean, or digits of the variance are lost.
struct PowerSums {
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;

  void add(double value);
  [[nodiscard]] PowerSums without(const PowerSums& other) const;
  [[nodiscard]] double mean() const;      ///< 0 without values.
  [[nodiscard]] double variance() const;  ///< The sample variance (n - 1), >= 0; 0 below two values.
};

}  // namespace kith
