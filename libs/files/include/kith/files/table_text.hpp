#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>

namespace kith {

/// Bytes of the largest table that is read from a file.
inline constexpr std::uint64_t kMaxTableBytes = 4'000'000'000;
/// Bytes of the largest table that is read from a pipe, a terminal or a device, of which nobody knows beforehand
/// whether it ends.
inline constexpr std::uint64_t kMaxStreamBytes = 500'000'000;

/// The text of a table. Reading ends at a zero byte, which no table has and read_csv() complains about.
/// @throws kith::Error (kIo) if it cannot be read; with E0513 if it is too large, E1201 if memory does not suffice.
[[nodiscard]] std::string read_table_text(const std::filesystem::path& path);

/// The same from a stream; `name` is used in messages.
[[nodiscard]] std::string read_table_text(std::istream& stream, const std::string& name);

}  // namespace kith
