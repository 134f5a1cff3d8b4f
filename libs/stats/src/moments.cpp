#include "kith/stats/moments.hpp"

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

}  // namespace kith
