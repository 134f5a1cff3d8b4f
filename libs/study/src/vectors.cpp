#include "vectors.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

namespace kith::detail {
namespace {

constexpr std::int64_t kLargest = 1'000'000'000;

template <typename Number>
std::optional<std::vector<Number>> parse_numbers(const std::string& text, std::size_t count) {
  std::istringstream words{text};
  std::vector<Number> numbers;
  for (std::string word; words >> word;) {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    if (!(value >= -kLargest && value <= kLargest)) return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

}  // namespace

std::optional<IntegerVector> parse_vector(const std::string& text, std::size_t dimension) {
  const auto numbers = parse_numbers<std::int64_t>(text, dimension);
  if (!numbers) return std::nullopt;
  return IntegerVector{std::span{*numbers}};
}

std::optional<IntegerVector> parse_counts(const std::string& text, std::size_t dimension, std::int64_t scale) {
  if (scale == 1) return parse_vector(text, dimension);
  const auto numbers = parse_numbers<double>(text, dimension);
  if (!numbers) return std::nullopt;
  IntegerVector counts(dimension);
  for (std::size_t k = 0; k < dimension; ++k) counts[k] = std::llround((*numbers)[k] * static_cast<double>(scale));
  return counts;
}

std::optional<std::vector<HalfSpace>> parse_half_spaces(const std::string& text, std::size_t dimension) {
  std::vector<HalfSpace> result;
  if (text.find_first_not_of(" \t") == std::string::npos) return result;
  std::istringstream parts{text};
  for (std::string part; std::getline(parts, part, ';');) {
    const auto normal = parse_vector(part, dimension);
    if (!normal || normal->is_zero()) return std::nullopt;
    result.emplace_back(*normal);
  }
  return result;
}

}  // namespace kith::detail
