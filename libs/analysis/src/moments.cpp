#include "kith/analysis/moments.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kith {

double mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument{"mean: there are no values"};
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::optional<double> standard_deviation(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double centre = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / (static_cast<double>(values.size()) - 1.0));
}

double jackknife_error(std::span<const double> without) {
  const double centre = mean(without);
  double squares = 0.0;
  for (const double value : without) squares += (value - centre) * (value - centre);
  const auto n = static_cast<double>(without.size());
  return std::sqrt((n - 1.0) / n * squares);
}

void PowerSums::add(double value) {
  n += 1.0;
  sum += value;
  squares += value * value;
}

PowerSums PowerSums::without(const PowerSums& other) const {
  return {n - other.n, sum - other.sum, squares - other.squares};
}

double PowerSums::mean() const { return n > 0.0 ? sum / n : 0.0; }

double PowerSums::variance() const { return n > 1.0 ? std::max(0.0, (squares - sum * sum / n) / (n - 1.0)) : 0.0; }

}  // namespace kith
