#include "vectors.hpp"

#include <charconv>
#include <sstream>

#include "open_table.hpp"

namespace kith::detail {

std::optional<IntegerVector> parse_vector(const std::string& text) {
  constexpr std::int64_t kLargest = 1'000'000'000;
  const auto words = words_of(text);
  if (words.size() != 3) return std::nullopt;
  IntegerVector result(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& word = words[k];
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    if (value < -kLargest || value > kLargest) return std::nullopt;
    result[k] = value;
  }
  return result;
}

std::optional<std::vector<HalfSpace>> parse_half_spaces(const std::string& text) {
  std::vector<HalfSpace> result;
  if (words_of(text).empty()) return result;
  std::istringstream parts{text};
  for (std::string part; std::getline(parts, part, ';');) {
    const auto normal = parse_vector(part);
    if (!normal || normal->is_zero()) return std::nullopt;
    result.emplace_back(*normal);
  }
  return result;
}

}  // namespace kith::detail
