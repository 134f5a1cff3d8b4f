#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace kith {

/// What a column of a row may hold.
enum class SqliteType : std::uint8_t {
  kRowNumber,  ///< INTEGER PRIMARY KEY: in the file it is the number of the row, and the column is empty.
  kInteger,
  kText,
  kTextOrNull,
  kBlob,
};

/// A value of a row: nothing, an integer, or the bytes of a text or blob.
using SqliteValue = std::variant<std::monostate, std::int64_t, std::string>;

/// A row as it stands in a page of an SQLite file, in the order of the columns.
struct SqliteRow {
  std::int64_t number = 0;  ///< rowid
  std::vector<SqliteValue> values;
};

/// The size of pages of the databases that scan_sqlite_rows() can read.
inline constexpr int kSqlitePageSize = 4096;

/// Reads what can be read of a damaged SQLite file without SQLite's help, which gives up on a file whose header, length
/// or inner pages are wrong: looks at every place of every page, in the file and in the write-ahead log beside it, for
/// rows with columns of these types, and offers them to `accept`. It must tell by a checksum whether a row is intact
/// and of the table that is wanted: whatever else is in the files is offered too if it has the same form. Pages that
/// cannot be read are passed over. A row may be offered several times.
///
/// @param columns  at least one.
/// @param accept   returns whether the row is intact; otherwise other readings of the same place are offered.
/// @throws kith::Error (kIo) if the file cannot be opened; std::invalid_argument without columns.
void scan_sqlite_rows(const std::filesystem::path& path, std::span<const SqliteType> columns,
                      const std::function<bool(const SqliteRow& row)>& accept);

}  // namespace kith
