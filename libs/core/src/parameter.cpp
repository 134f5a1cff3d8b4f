#include "kith/core/parameter.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "kith/core/error.hpp"

namespace kith {
namespace {

std::string number(double value) {
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  constexpr double kWhole = 1e15;  // up to here plain digits are exact, and easier to read
  if (std::abs(value) < kWhole && value == std::trunc(value)) return std::to_string(static_cast<std::int64_t>(value));
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

template <typename T>
bool is(const Parameter& parameter) {
  return std::holds_alternative<T>(parameter.default_value);
}

[[noreturn]] void refuse(const Parameter& parameter, const ParameterValue& value) {
  const auto range = range_of(parameter);
  throw Error{ErrorKind::kInvalidInput, "parameter '" + std::string{parameter.name} + "' cannot be " +
                                            to_string(value) + ": it is " + type_of(parameter) +
                                            (range.empty() ? "" : " in " + range)};
}

bool is_in_range(const Parameter& parameter, double value) {
  const bool above = parameter.min_is_open ? value > parameter.min : value >= parameter.min;
  const bool below = parameter.max_is_open ? value < parameter.max : value <= parameter.max;
  return above && below;
}

}  // namespace

bool is_possible(const Parameter& parameter, const ParameterValue& value) {
  if (value.index() != parameter.default_value.index()) return false;
  if (const auto* real = std::get_if<double>(&value)) return is_in_range(parameter, *real);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return is_in_range(parameter, static_cast<double>(*count));
  if (const auto* word = std::get_if<std::string>(&value)) {
    return parameter.words.empty() ||
           std::find(parameter.words.begin(), parameter.words.end(), *word) != parameter.words.end();
  }
  if (const auto* spread = std::get_if<Spread>(&value)) {
    if (spread->half_normal.has_value() == spread->value.has_value()) return false;
    return is_in_range(parameter, spread->value ? *spread->value : *spread->half_normal);
  }
  return true;
}

std::string type_of(const Parameter& parameter) {
  if (is<double>(parameter)) return "a number";
  if (is<std::int64_t>(parameter)) return "a whole number";
  if (is<bool>(parameter)) return "true or false";
  if (is<Spread>(parameter)) return "{ half_normal = ... } or { value = ... }";
  if (parameter.words.empty()) return "a string";
  std::string text = "one of";
  for (const auto word : parameter.words) text.append(text == "one of" ? " " : ", ").append(word);
  return text;
}

std::string range_of(const Parameter& parameter) {
  if (is<bool>(parameter) || is<std::string>(parameter)) return {};
  return (parameter.min_is_open ? "(" : "[") + number(parameter.min) + ", " + number(parameter.max) +
         (parameter.max_is_open ? ")" : "]");
}

std::string to_string(const ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return number(*real);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  const auto& spread = std::get<Spread>(value);
  std::string text;
  if (spread.half_normal) text += "half_normal = " + number(*spread.half_normal);
  if (spread.value) text += (text.empty() ? "value = " : ", value = ") + number(*spread.value);
  return text.empty() ? "{}" : "{ " + text + " }";
}

ParameterValues::ParameterValues(std::span<const Parameter> declared) : declared_{declared} {
  values_.reserve(declared.size());
  for (const auto& parameter : declared) values_.push_back(parameter.default_value);
}

void ParameterValues::set(std::string_view name, ParameterValue value) {
  const auto found =
      std::find_if(declared_.begin(), declared_.end(), [&](const Parameter& one) { return one.name == name; });
  if (found == declared_.end()) {
    throw std::invalid_argument{"ParameterValues::set: there is no parameter '" + std::string{name} + "'"};
  }
  const auto* whole = std::get_if<std::int64_t>(&value);
  if (whole != nullptr && is<double>(*found)) value = static_cast<double>(*whole);
  if (!is_possible(*found, value)) refuse(*found, value);
  values_[static_cast<std::size_t>(found - declared_.begin())] = std::move(value);
}

template <typename T>
const T& ParameterValues::get(std::string_view name) const {
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    if (declared_[i].name != name) continue;
    if (const auto* value = std::get_if<T>(&values_[i])) return *value;
    break;
  }
  throw std::invalid_argument{"ParameterValues: there is no parameter '" + std::string{name} + "' of this type"};
}

double ParameterValues::real(std::string_view name) const { return get<double>(name); }
std::int64_t ParameterValues::count(std::string_view name) const { return get<std::int64_t>(name); }
bool ParameterValues::boolean(std::string_view name) const { return get<bool>(name); }
const std::string& ParameterValues::word(std::string_view name) const { return get<std::string>(name); }
const Spread& ParameterValues::spread(std::string_view name) const { return get<Spread>(name); }

}  // namespace kith
