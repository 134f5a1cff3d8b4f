#include "reward.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string_view>

#include "kith/core/assert.hpp"

namespace kith::detail {
namespace {

// digits * 10^exponent, without trailing zeros in digits.
struct Decimal {
  std::int64_t digits = 0;
  int exponent = 0;
};

Decimal shortest_decimal(double number) {
  std::array<char, 64> buffer{};
  const auto written =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::scientific);
  const std::string_view text{buffer.data(), static_cast<std::size_t>(written.ptr - buffer.data())};
  const auto mark = text.find('e');
  KITH_ASSERT(written.ec == std::errc{} && mark != std::string_view::npos);

  Decimal decimal;
  bool fraction = false;
  for (const char c : text.substr(0, mark)) {
    if (c == '.') fraction = true;
    if (c < '0' || c > '9') continue;
    decimal.digits = decimal.digits * 10 + (c - '0');
    decimal.exponent -= fraction ? 1 : 0;
  }
  const std::string_view exponent = text.substr(mark + (text[mark + 1] == '+' ? 2 : 1));
  int power = 0;
  std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  decimal.exponent += power;
  while (decimal.digits != 0 && decimal.digits % 10 == 0) {
    decimal.digits /= 10;
    ++decimal.exponent;
  }
  if (number < 0.0) decimal.digits = -decimal.digits;
  return decimal;
}

}  // namespace

std::optional<IntegerVector> exact_direction(const std::vector<double>& numbers) {
  std::vector<Decimal> decimals;
  int lowest = std::numeric_limits<int>::max();
  for (const double number : numbers) {
    decimals.push_back(shortest_decimal(number));
    if (decimals.back().digits != 0) lowest = std::min(lowest, decimals.back().exponent);
  }

  // All as multiples of the smallest power of ten that one of them ends in.
  std::vector<std::int64_t> entries;
  std::int64_t divisor = 0;
  for (const Decimal& decimal : decimals) {
    Int128 scaled = decimal.digits;
    for (int power = lowest; decimal.digits != 0 && power < decimal.exponent; ++power) {
      scaled *= 10;
      if (scaled > std::numeric_limits<std::int64_t>::max() || scaled < -std::numeric_limits<std::int64_t>::max()) {
        return std::nullopt;
      }
    }
    entries.push_back(static_cast<std::int64_t>(scaled));
    divisor = std::gcd(divisor, entries.back());
  }

  for (std::int64_t& entry : entries) {
    if (divisor != 0) entry /= divisor;
    if (std::abs(entry) >= std::int64_t{1} << 31) return std::nullopt;
  }
  return IntegerVector{std::span<const std::int64_t>{entries}};
}

}  // namespace kith::detail
