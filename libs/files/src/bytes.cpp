#include "kith/files/bytes.hpp"

#include <array>
#include <bit>

namespace kith {
namespace {

constexpr unsigned kGroup = 7;
constexpr std::uint64_t kGroupMask = 0x7F;
constexpr std::uint64_t kMore = 0x80;

}  // namespace

void ByteWriter::count(std::uint64_t value) {
  for (; value > kGroupMask; value >>= kGroup) bytes_ += static_cast<char>((value & kGroupMask) | kMore);
  bytes_ += static_cast<char>(value);
}

void ByteWriter::integer(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  count((bits << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0));
}

void ByteWriter::real(double value) {
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i, bits >>= 8) bytes_ += static_cast<char>(bits & 0xFF);
}

void ByteWriter::text(std::string_view value) {
  count(value.size());
  bytes_ += value;
}

void ByteWriter::reals(const std::vector<double>& values) {
  count(values.size());
  for (const double value : values) real(value);
}

void ByteWriter::vector(const IntegerVector& values) {
  count(values.size());
  for (const auto value : values) integer(value);
}

std::uint64_t ByteReader::count() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += kGroup) {
    const auto byte = static_cast<std::uint64_t>(static_cast<unsigned char>(letter()));
    value |= (byte & kGroupMask) << shift;
    if ((byte & kMore) == 0) return value;
  }
  refuse();
  return 0;
}

std::int64_t ByteReader::integer() {
  const auto bits = count();
  return static_cast<std::int64_t>((bits >> 1) ^ ((bits & 1) != 0 ? ~std::uint64_t{0} : 0));
}

double ByteReader::real() {
  if (left_.size() < 8) refuse();
  if (!ok_) return 0.0;
  std::uint64_t bits = 0;
  for (unsigned i = 0; i < 8; ++i) bits |= std::uint64_t{static_cast<unsigned char>(left_[i])} << (8 * i);
  left_.remove_prefix(8);
  return std::bit_cast<double>(bits);
}

char ByteReader::letter() {
  if (left_.empty()) refuse();
  if (!ok_) return '\0';
  const char byte = left_.front();
  left_.remove_prefix(1);
  return byte;
}

std::size_t ByteReader::length(std::size_t size) {
  const auto n = count();
  if (n <= left_.size() / size) return static_cast<std::size_t>(n);
  refuse();
  return 0;
}

std::string ByteReader::text() {
  const auto n = length();
  std::string value{left_.substr(0, n)};
  left_.remove_prefix(n);
  return value;
}

std::vector<double> ByteReader::reals() {
  std::vector<double> values(length(8));
  for (auto& value : values) value = real();
  return values;
}

IntegerVector ByteReader::vector() {
  const auto n = length();
  if (n > IntegerVector::kMaxDimension) refuse();
  std::array<std::int64_t, IntegerVector::kMaxDimension> entries{};
  const std::size_t size = ok_ ? n : 0;
  for (std::size_t k = 0; k < size; ++k) entries[k] = integer();
  return IntegerVector{std::span<const std::int64_t>{entries.data(), size}};
}

}  // namespace kith
