#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>

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
  explicit IntegerVector(std::size_t dimension);
  IntegerVector(std::initializer_list<std::int64_t> entries);
  explicit IntegerVector(std::span<const std::int64_t> entries);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::int64_t operator[](std::size_t k) const { return entries_[k]; }
  [[nodiscard]] std::int64_t& operator[](std::size_t k) { return entries_[k]; }
  [[nodiscard]] const std::int64_t* begin() const noexcept { return entries_.data(); }
  [[nodiscard]] const std::int64_t* end() const noexcept { return entries_.data() + size_; }
  [[nodiscard]] bool is_zero() const noexcept;

  IntegerVector& operator+=(const IntegerVector& other) noexcept;
  IntegerVector& operator-=(const IntegerVector& other) noexcept;
  [[nodiscard]] friend IntegerVector operator+(IntegerVector a, const IntegerVector& b) noexcept { return a += b; }
  [[nodiscard]] friend IntegerVector operator-(IntegerVector a, const IntegerVector& b) noexcept { return a -= b; }
  [[nodiscard]] IntegerVector operator-() const noexcept;

  /// Lexicographic in the entries; vectors of different dimension are ordered by dimension first.
  friend std::strong_ordering operator<=>(const IntegerVector& a, const IntegerVector& b) noexcept;
  friend bool operator==(const IntegerVector& a, const IntegerVector& b) noexcept = default;

 private:
  std::size_t size_ = 0;
  std::array<std::int64_t, kMaxDimension> entries_{};  // entries beyond size_ stay 0
};

/// a . b, exactly. @pre equal dimensions.
[[nodiscard]] Int128 dot(const IntegerVector& a, const IntegerVector& b) noexcept;

/// -1, 0 or 1: the exact sign of a . b.
[[nodiscard]] int sign_of_dot(const IntegerVector& a, const IntegerVector& b) noexcept;

/// a . x in double precision, summed from the first entry on. @pre x has a.size() entries.
[[nodiscard]] double dot(const IntegerVector& a, std::span<const double> x) noexcept;

/// The vector divided by the greatest common divisor of its entries; zero stays zero.
[[nodiscard]] IntegerVector primitive(const IntegerVector& v) noexcept;

/// a x b in three dimensions. @throws std::invalid_argument unless both have d = 3;
/// @throws std::overflow_error if an entry leaves 64 bits.
[[nodiscard]] IntegerVector cross(const IntegerVector& a, const IntegerVector& b);

/// "(1,0,-4)".
[[nodiscard]] std::string to_string(const IntegerVector& v);

}  // namespace kith

template <>
struct std::hash<kith::IntegerVector> {
  std::size_t operator()(const kith::IntegerVector& v) const noexcept;
};
