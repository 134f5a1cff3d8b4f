#include "cell_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kith {
namespace {

double largest_size(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// The power of two that is just above.
int exponent_above(double size) { return size > 0.0 ? std::ilogb(size) + 1 : 0; }

}  // namespace

StandardizedResponse standardize(std::span<const double> response) {
  StandardizedResponse result;
  result.values.assign(response.begin(), response.end());
  if (response.empty()) return result;
  auto& values = result.values;

  const int size_exponent = exponent_above(largest_size(response));
  for (auto& value : values) value = std::ldexp(value, -size_exponent);
  // Differences from one of the values are exact where values are near each other, and exactly 0 where all are equal.
  const double origin = values.front();
  for (auto& value : values) value -= origin;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (auto& value : values) value -= mean;

  const int spread_exponent = exponent_above(largest_size(values));
  for (auto& value : values) value = std::ldexp(value, -spread_exponent);
  result.centre = std::ldexp(origin + mean, size_exponent);
  result.exponent = size_exponent + spread_exponent;
  result.rounding = std::ldexp(std::numeric_limits<double>::epsilon(), -spread_exponent);
  return result;
}

CellMoments moments_of(std::span<const double> values, const CellDesign& design) {
  // Differences from a cell's first value: a cell whose values are all equal has exactly no spread.
  CellMoments cells{std::vector<double>(design.counts.size(), 0.0), 0.0};
  std::vector<double> first(design.counts.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto cell = design.cell_of[i];
    if (std::isnan(first[cell])) first[cell] = values[i];
    cells.means[cell] += values[i] - first[cell];
  }
  for (std::size_t c = 0; c < first.size(); ++c)
    cells.means[c] = first[c] + cells.means[c] / static_cast<double>(design.counts[c]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - cells.means[design.cell_of[i]];
    cells.within += difference * difference;
  }
  return cells;
}

double term_sum_of_squares(const CellDesign& design, std::size_t term, const std::vector<double>& means) {
  const auto effect = design.effect(design.terms[term], means);
  double sum = 0.0;
  for (std::size_t c = 0; c < effect.size(); ++c) sum += static_cast<double>(design.counts[c]) * effect[c] * effect[c];
  return sum;
}

std::vector<double> squares_in_strata(std::span<const double> values, std::span<const Factor> groups) {
  std::vector<double> squares;
  double before = 0.0;
  for (const auto& level : groups) {
    std::vector<double> sums(level.levels.size(), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) sums[level.codes[i]] += values[i];
    const double size = static_cast<double>(values.size()) / static_cast<double>(sums.size());
    const double all = std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0) / size;
    squares.push_back(all - before);
    before = all;
  }
  squares.push_back(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) - before);
  return squares;
}

}  // namespace kith
