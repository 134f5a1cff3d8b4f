#include "write_ahead_log.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "kith/files/atomic_file.hpp"

namespace kith {
namespace {

// https://www.sqlite.org/fileformat2.html#walformat
constexpr std::size_t kHeader = 32;
constexpr std::size_t kFrameHeader = 24;
constexpr std::uint32_t kMagic = 0x377F0682;  // the last bit says whether checksums are of big-endian words

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i > 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i - 1]);
  return value;
}

struct Sum {
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  void add(std::string_view bytes, bool big) {
    const auto word = [&](std::size_t at) {
      return big ? big_endian(bytes.substr(at, 4)) : little_endian(bytes.substr(at, 4));
    };
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
      first += word(at) + second;
      second += word(at + 4) + first;
    }
  }
  [[nodiscard]] bool is_at(std::string_view bytes) const {
    return big_endian(bytes.substr(0, 4)) == first && big_endian(bytes.substr(4, 4)) == second;
  }
};

}  // namespace

bool log_is_damaged(const std::filesystem::path& database) {
  const auto path = std::filesystem::path{database}.concat("-wal");
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return false;
  const std::string log = read_file(path);
  const std::string_view text{log};
  if (text.size() <= kHeader + kFrameHeader) return false;
  const auto magic = big_endian(text);
  const bool big = (magic & 1u) != 0;
  Sum sum;
  sum.add(text.substr(0, 24), big);
  if ((magic & ~1u) != kMagic || !sum.is_at(text.substr(24))) return true;
  const std::size_t page = big_endian(text.substr(8));
  const auto salt = text.substr(16, 8);
  bool broken = false;
  for (std::size_t at = kHeader; at + kFrameHeader + page <= text.size(); at += kFrameHeader + page) {
    const auto frame = text.substr(at, kFrameHeader);
    const bool is_ours = frame.substr(8, 8) == salt;
    sum.add(frame.substr(0, 8), big);
    sum.add(text.substr(at + kFrameHeader, page), big);
    const bool is_whole = sum.is_at(frame.substr(16));
    // Frames of an earlier log may follow, but they have other checksums: here only the salt was changed.
    if (is_whole && !is_ours) return true;
    if (!is_whole) broken = true;
    const bool commits = big_endian(frame.substr(4)) != 0;
    if (broken && is_ours && commits) return true;
  }
  return false;
}

}  // namespace kith
