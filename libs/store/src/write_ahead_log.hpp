#pragma once

#include <filesystem>

namespace kith {

// Whether the write-ahead log beside the database has lost transactions that were complete: SQLite reads it up to the
// first frame whose checksum is wrong and does not say when a commit follows that frame. What a killed process leaves,
// frames of a transaction without its commit, is no damage.
[[nodiscard]] bool log_is_damaged(const std::filesystem::path& database);

}  // namespace kith
