#include "count_cells.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <unordered_map>

namespace kith::detail {
namespace {

// The cell of each observation. Numbers are dealt out factor by factor, so that they never exceed observations times
// levels, however many combinations of levels there are.
std::vector<std::size_t> cell_of_each(std::size_t observations, std::span<const Factor> factors) {
  std::vector<std::size_t> cell_of(observations, 0);
  for (const auto& factor : factors) {
    std::unordered_map<std::size_t, std::size_t> number_of;
    for (std::size_t i = 0; i < observations; ++i) {
      const auto pair = cell_of[i] * factor.levels.size() + factor.codes[i];
      cell_of[i] = number_of.emplace(pair, number_of.size()).first->second;
    }
  }
  return cell_of;
}

std::vector<CountFrequency> frequencies_of(std::span<const double> counts) {
  std::vector<double> sorted(counts.begin(), counts.end());
  std::ranges::sort(sorted);
  std::vector<CountFrequency> frequencies;
  for (const double count : sorted) {
    if (frequencies.empty() || frequencies.back().count != count) frequencies.push_back({count, 0.0});
    frequencies.back().observations += 1.0;
  }
  return frequencies;
}

}  // namespace

CountData summarise_counts(std::span<const double> counts, std::span<const Factor> factors) {
  CountData data;
  const auto cell_of = cell_of_each(counts.size(), factors);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (cell_of[i] == data.cells.size()) {
      data.cells.emplace_back();
      for (const auto& factor : factors) data.cells.back().levels.push_back(factor.codes[i]);
    }
    auto& cell = data.cells[cell_of[i]];
    cell.observations += 1.0;
    cell.sum += counts[i];
    data.sum += counts[i];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto& cell = data.cells[cell_of[i]];
    const double deviation = counts[i] - cell.sum / cell.observations;
    cell.squares += deviation * deviation;
  }
  data.observations = static_cast<double>(counts.size());
  data.frequencies = frequencies_of(counts);
  for (const auto& [count, observations] : data.frequencies)
    data.log_factorials += observations * boost::math::lgamma(count + 1.0);
  return data;
}

}  // namespace kith::detail
