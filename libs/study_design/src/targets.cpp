#include "kith/study_design/targets.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kith {

namespace {

constexpr double kSmallestFigure = 1e-12;  // a model without spread misses by much, not by infinitely much

}  // namespace

std::string to_string(const Target& target) {
  if (target.effect) return "F of " + to_string(*target.effect);
  return std::string{name_of(target.quantity)} + " of " + to_string(target.teams) +
         (target.statistic == Statistic::kMean ? ", mean" : ", sd");
}

double compared(const Target& target, double figure) {
  return target.is_factor ? std::log(std::max(figure, kSmallestFigure)) : figure;
}

double compared_error(const Target& target, double figure, double standard_error) {
  return target.is_factor ? standard_error / std::max(figure, kSmallestFigure) : standard_error;
}

double published_error(const Target& target) {
  if (target.standard_error) return compared_error(target, target.value, *target.standard_error);
  return (target.is_factor ? std::log(target.tolerance) : target.tolerance) / 2.0;
}

double miss(const Target& target, double model) {
  const double tolerance = target.is_factor ? std::log(target.tolerance) : target.tolerance;
  return (compared(target, model) - compared(target, target.value)) / tolerance;
}

FMoments f_moments(double df1, double df2, double non_centrality) {
  const double all = df1 + non_centrality, ratio = df2 / df1;
  FMoments moments;
  moments.mean = df2 * all / (df1 * (df2 - 2.0));
  moments.sd = ratio * std::sqrt(2.0 * (all * all + (all + non_centrality) * (df2 - 2.0)) / (df2 - 4.0)) / (df2 - 2.0);
  return moments;
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
