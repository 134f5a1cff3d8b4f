#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace kith::faults {

/// The records of teams, as sound journals of one study have them: every form that a record of this number has.
struct Records {
  std::string table{}, number{}, content{};  ///< Where SQLite has them: names of the table and its two columns.
  std::map<std::int64_t, std::set<std::string>> forms{};
};

/// Adds the records of a sound journal, or of none. Its table is the one that has an integer key and a blob.
/// @throws kith::Error if there is no such table
void add_records(const std::filesystem::path& journal, Records& records);

/// The numbers of those records that can still be read from the journals of a folder, what is kept of damaged ones
/// included, whatever their state. Works on copies in `scratch`, which must not exist.
[[nodiscard]] std::set<std::int64_t> readable_records(const std::filesystem::path& folder, const Records& records,
                                                      const std::filesystem::path& scratch);

}  // namespace kith::faults
