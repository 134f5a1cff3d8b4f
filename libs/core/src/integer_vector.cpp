#include "kith/core/integer_vector.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>

namespace kith {
namespace {

// Well-defined for the smallest integer too, whose negation does not exist.
std::uint64_t magnitude(std::int64_t x) noexcept {
  const auto bits = static_cast<std::uint64_t>(x);
  return x < 0 ? std::uint64_t{0} - bits : bits;
}

std::int64_t narrow(Int128 x) {
  if (x < std::numeric_limits<std::int64_t>::min() || x > std::numeric_limits<std::int64_t>::max()) {
    throw std::overflow_error{"cross: an entry leaves 64 bits"};
  }
  return static_cast<std::int64_t>(x);
}

}  // namespace

void IntegerVector::reject(std::size_t dimension) {
  throw std::invalid_argument{"IntegerVector: the dimension must be at most 8, not " + std::to_string(dimension)};
}

IntegerVector primitive(const IntegerVector& v) noexcept {
  std::uint64_t divisor = 0;
  for (const std::int64_t x : v) {
    divisor = std::gcd(divisor, magnitude(x));
    if (divisor == 1) return v;
  }
  if (divisor == 0) return v;
  IntegerVector result = v;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const std::uint64_t quotient = magnitude(v[k]) / divisor;
    result[k] = static_cast<std::int64_t>(v[k] < 0 ? std::uint64_t{0} - quotient : quotient);
  }
  return result;
}

IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  if (a.size() != 3 || b.size() != 3) throw std::invalid_argument{"cross: both vectors must have three entries"};
  const auto minor = [&](std::size_t i, std::size_t j) { return narrow(Int128{a[i]} * b[j] - Int128{a[j]} * b[i]); };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

std::string to_string(const IntegerVector& v) {
  std::string text = "(";
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (k > 0) text += ',';
    text += std::to_string(v[k]);
  }
  return text + ")";
}

}  // namespace kith
