#include "kith/planning/targets.hpp"

#include <charconv>
#include <cmath>

namespace kith {

std::string to_string(const Target& target) {
  return std::string{name_of(target.quantity)} + " of " + to_string(target.teams) +
         (target.statistic == Statistic::kMean ? ", mean" : ", sd");
}

double miss(const Target& target, double model) {
  if (!target.is_factor) return (model - target.value) / target.tolerance;
  constexpr double kSmallestFigure = 1e-12;  // a model without spread misses by much, not by infinitely much
  return std::log(std::max(model, kSmallestFigure) / target.value) / std::log(target.tolerance);
}

std::vector<std::string> overrides_of(const std::vector<FreeParameter>& parameters, const std::vector<double>& values) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    char buffer[40];
    char* end = nullptr;
    if (parameters[i].integer) {
      end = std::to_chars(buffer, buffer + sizeof buffer, std::llround(values[i])).ptr;
    } else {
      end = std::to_chars(buffer, buffer + sizeof buffer, values[i]).ptr;
    }
    for (const auto& key : parameters[i].keys) result.push_back(key + "=" + std::string(buffer, end));
  }
  return result;
}

}  // namespace kith
