#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>

#include "kith/core/assert.hpp"

namespace kith {

/// 128-bit integers, in which every predicate on IntegerVectors is exact.
__extension__ using Int128 = __int128;

/// A short vector of integers: feature counts of a trajectory, or the normal of
/// a half-space. Dimension d = number of reward features, 0 to 8. Values are
/// stored in place; there is no allocation. Ordered lexicographically.
///
/// Range: sums and differences are not checked; entries stay below 2^31 in
/// every use (counts are bounded by path lengths), so that products of three
/// entries are exact in Int128.
class IntegerVector {
 public:
  static constexpr std::size_t kMaxDimension = 8;

  IntegerVector() = default;
  /// The zero vector. @throws std::invalid_argument if dimension > 8.
  explicit IntegerVector(std::size_t dimension) : size_{checked(dimension)} {}
  /// @throws std::invalid_argument for more than 8 entries.
  IntegerVector(std::initializer_list<std::int64_t> entries) : size_{checked(entries.size())} {
    std::copy(entries.begin(), entries.end(), entries_.begin());
  }
  /// @throws std::invalid_argument for more than 8 entries.
  explicit IntegerVector(std::span<const std::int64_t> entries) : size_{checked(entries.size())} {
    std::copy(entries.begin(), entries.end(), entries_.begin());
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::int64_t operator[](std::size_t k) const { return entries_[k]; }
  [[nodiscard]] std::int64_t& operator[](std::size_t k) { return entries_[k]; }
  [[nodiscard]] const std::int64_t* begin() const noexcept { return entries_.data(); }
  [[nodiscard]] const std::int64_t* end() const noexcept { return entries_.data() + size_; }
  [[nodiscard]] bool is_zero() const noexcept {
    return std::all_of(begin(), end(), [](std::int64_t x) { return x == 0; });
  }

  /// Entry by entry. @pre equal dimensions (asserted).
  IntegerVector& operator+=(const IntegerVector& other) {
    KITH_ASSERT(size_ == other.size_);
    for (std::size_t k = 0; k < size_; ++k) entries_[k] += other.entries_[k];
    return *this;
  }
  /// Entry by entry. @pre equal dimensions (asserted).
  IntegerVector& operator-=(const IntegerVector& other) {
    KITH_ASSERT(size_ == other.size_);
    for (std::size_t k = 0; k < size_; ++k) entries_[k] -= other.entries_[k];
    return *this;
  }
  [[nodiscard]] friend IntegerVector operator+(IntegerVector a, const IntegerVector& b) { return a += b; }
  [[nodiscard]] friend IntegerVector operator-(IntegerVector a, const IntegerVector& b) { return a -= b; }
  [[nodiscard]] IntegerVector operator-() const noexcept {
    IntegerVector result = *this;
    for (std::size_t k = 0; k < size_; ++k) result.entries_[k] = -entries_[k];
    return result;
  }

  /// Lexicographic in the entries; vectors of different dimension are ordered by dimension first.
  friend std::strong_ordering operator<=>(const IntegerVector& a, const IntegerVector& b) noexcept = default;
  friend bool operator==(const IntegerVector& a, const IntegerVector& b) noexcept = default;

 private:
  static std::size_t checked(std::size_t dimension) {
    if (dimension > kMaxDimension) reject(dimension);
    return dimension;
  }
  [[noreturn]] static void reject(std::size_t dimension);

  std::size_t size_ = 0;                               // compared first
  std::array<std::int64_t, kMaxDimension> entries_{};  // entries beyond size_ stay 0
};

/// a . b, exactly. @pre equal dimensions (asserted).
[[nodiscard]] inline Int128 dot(const IntegerVector& a, const IntegerVector& b) {
  KITH_ASSERT(a.size() == b.size());
  Int128 sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += Int128{a[k]} * b[k];
  return sum;
}

/// -1, 0 or 1: the sign of an exact number.
[[nodiscard]] constexpr int sign(Int128 x) noexcept { return static_cast<int>(x > 0) - static_cast<int>(x < 0); }

/// -1, 0 or 1: the exact sign of a . b. @pre equal dimensions (asserted).
[[nodiscard]] inline int sign_of_dot(const IntegerVector& a, const IntegerVector& b) { return sign(dot(a, b)); }

/// a . x in double precision, summed from the first entry on. @pre x has a.size() entries (asserted).
[[nodiscard]] inline double dot(const IntegerVector& a, std::span<const double> x) {
  KITH_ASSERT(a.size() == x.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += static_cast<double>(a[k]) * x[k];
  return sum;
}

/// The vector divided by the greatest common divisor of its entries; zero stays
/// zero. The direction is unchanged.
[[nodiscard]] IntegerVector primitive(const IntegerVector& v) noexcept;

/// a x b in three dimensions. @throws std::invalid_argument unless both have d = 3;
/// @throws std::overflow_error if an entry leaves 64 bits, which cannot happen
/// while the entries of both stay below 2^31.
[[nodiscard]] IntegerVector cross(const IntegerVector& a, const IntegerVector& b);

/// "(1,0,-4)".
[[nodiscard]] std::string to_string(const IntegerVector& v);

}  // namespace kith

/// Equal vectors have equal hashes; the same on every platform.
template <>
struct std::hash<kith::IntegerVector> {
  std::size_t operator()(const kith::IntegerVector& v) const noexcept {
    std::uint64_t bits = 0x9E3779B97F4A7C15ull * (v.size() + 1);
    for (const std::int64_t x : v) {
      bits = (bits ^ static_cast<std::uint64_t>(x)) * 0xFF51AFD7ED558CCDull;
      bits ^= bits >> 32;
    }
    return static_cast<std::size_t>(bits);
  }
};
