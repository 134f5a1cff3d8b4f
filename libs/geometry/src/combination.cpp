#include "combination.hpp"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace kith::detail {
namespace {

using Int256 = boost::multiprecision::int256_t;

// In 64 bits, which is nearly always enough.
std::optional<IntegerVector> short_combination(Int128 a, const IntegerVector& x, Int128 b, const IntegerVector& y) {
  const auto short_a = static_cast<std::int64_t>(a);
  const auto short_b = static_cast<std::int64_t>(b);
  if (short_a != a || short_b != b) return std::nullopt;
  IntegerVector sum(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    std::int64_t first = 0;
    std::int64_t second = 0;
    if (__builtin_mul_overflow(short_a, x[k], &first) || __builtin_mul_overflow(short_b, y[k], &second) ||
        __builtin_add_overflow(first, second, &sum[k])) {
      return std::nullopt;
    }
  }
  return primitive(sum);
}

// In 256 bits: factors have at most 98, entries 64.
IntegerVector long_combination(Int128 a, const IntegerVector& x, Int128 b, const IntegerVector& y) {
  std::array<Int256, IntegerVector::kMaxDimension> sum;
  Int256 divisor = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sum[k] = Int256{a} * x[k] + Int256{b} * y[k];
    divisor = gcd(divisor, sum[k]);
  }
  IntegerVector result(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (divisor > 1) sum[k] /= divisor;
    if (sum[k] < std::numeric_limits<std::int64_t>::min() || sum[k] > std::numeric_limits<std::int64_t>::max()) {
      throw std::overflow_error{
          "Cone: an extreme ray leaves 64 bits; the entries of the half-spaces are too large for " +
          std::to_string(x.size()) + " dimensions"};
    }
    result[k] = static_cast<std::int64_t>(sum[k]);
  }
  return result;
}

}  // namespace

IntegerVector combination(Int128 a, const IntegerVector& x, Int128 b, const IntegerVector& y) {
  const auto result = short_combination(a, x, b, y);
  return result ? *result : long_combination(a, x, b, y);
}

}  // namespace kith::detail
