#include "parameter_box.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace kith {

std::vector<double> to_unit(const std::vector<FreeParameter>& parameters, std::span<const double> values) {
  std::vector<double> unit;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto& p = parameters[i];
    constexpr double kSmallest = 1e-300;  // the present value of a logarithmic parameter may be 0
    unit.push_back(p.logarithmic ? std::log(std::max(values[i], kSmallest) / p.min) / std::log(p.max / p.min)
                                 : (values[i] - p.min) / (p.max - p.min));
  }
  return unit;
}

std::vector<double> to_values(const std::vector<FreeParameter>& parameters, std::span<const double> unit) {
  std::vector<double> values;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto& p = parameters[i];
    const double value = p.logarithmic ? p.min * std::pow(p.max / p.min, unit[i]) : p.min + unit[i] * (p.max - p.min);
    values.push_back(std::clamp(p.integer ? std::round(value) : value, p.min, p.max));
  }
  return values;
}

std::vector<double> Box::place(std::span<const double> fraction) const {
  std::vector<double> point(fraction.size());
  for (std::size_t k = 0; k < point.size(); ++k) point[k] = low[k] + fraction[k] * (high[k] - low[k]);
  return point;
}

std::vector<double> Box::local(std::span<const double> unit) const {
  std::vector<double> point(unit.size());
  for (std::size_t k = 0; k < point.size(); ++k) point[k] = 2.0 * (unit[k] - low[k]) / (high[k] - low[k]) - 1.0;
  return point;
}

bool Box::contains(std::span<const double> unit, double margin) const {
  for (std::size_t k = 0; k < unit.size(); ++k) {
    const double slack = margin * (high[k] - low[k]) + 1e-12;
    if (unit[k] < low[k] - slack || unit[k] > high[k] + slack) return false;
  }
  return true;
}

double rounded(double value, double low, double high, bool integer) {
  const double half = (high - low) / 2.0;
  if (!(half > 0.0)) return integer ? std::round(value) : value;
  int exponent = static_cast<int>(std::floor(std::log10(half)));
  if (integer) exponent = std::max(exponent, 0);
  // By way of the decimal text, so that 0.1 is 0.1 and not three times a tenth of a third.
  const double step = std::pow(10.0, exponent);
  const auto multiple = std::llround(value / step);
  const auto text = std::to_string(multiple) + "e" + std::to_string(exponent);
  double result = value;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

}  // namespace kith
