#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/integer_vector.hpp"

namespace kith {

/// Encodes numbers and texts as consecutive bytes, the same on any machine: counts in groups of seven bits, the lowest
/// first; reals as their 64 bits, the lowest byte first; texts and lists after their length.
class ByteWriter {
 public:
  void count(std::uint64_t value);
  void integer(std::int64_t value);  ///< Zigzag: small magnitudes are short.
  void real(double value);
  void flag(bool value) { bytes_ += value ? '\1' : '\0'; }
  void letter(char value) { bytes_ += value; }
  void text(std::string_view value);
  void reals(const std::vector<double>& values);
  void vector(const IntegerVector& values);
  [[nodiscard]] std::string take() && { return std::move(bytes_); }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

/// Decodes what ByteWriter wrote. Safe for any bytes: nothing is read beyond their end and no list is longer than they
/// are. After the first value that does not fit, ok() is false and every value is zero.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_{bytes} {}
  std::uint64_t count();
  std::int64_t integer();
  double real();
  bool flag() { return letter() != '\0'; }
  char letter();
  std::string text();
  std::vector<double> reals();
  IntegerVector vector();
  /// The length of a list whose elements take at least `size` bytes each.
  std::size_t length(std::size_t size = 1);

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] bool at_end() const noexcept { return left_.empty(); }
  void refuse() noexcept {
    ok_ = false;
    left_ = {};
  }

 private:
  std::string_view left_;
  bool ok_ = true;
};

}  // namespace kith
