#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/files/column.hpp"

namespace kith {

/// A value of a table; std::monostate is a missing one.
using TableCell = std::variant<std::monostate, std::string, std::int64_t, double, bool>;

/// One row, in the order of the columns that were asked for.
struct CsvRow {
  std::size_t line;                     ///< Where the row begins in the file, from 1.
  std::span<const TableCell> cells;     ///< One per column, each missing or of the column's type.
  std::string_view text;                ///< All of the row as written, a part of the text that is read.
  std::span<const std::size_t> fields;  ///< Per column, which cell of the row it is.
  char separator = ',';                 ///< Between cells: ',', ';' or a tab.

  /// The cell of a column as written, quotes included (of several lines the first one): a part of the text that is
  /// read, so it says where the cell is.
  /// @throws std::out_of_range if there is no such column.
  [[nodiscard]] std::string_view written(std::size_t column) const;
};

/// true and false as kith and JSON write them, R (TRUE) and Python (True); nothing for any other text.
[[nodiscard]] std::optional<bool> truth_of(std::string_view text);
/// The text of a number with its only comma or point made a point, for tables whose cells are not
/// separated by commas.
[[nodiscard]] std::string with_decimal_point(std::string text);

/// What to do with columns of a file that were not asked for.
enum class OtherColumns { kReject, kIgnore };

/// Reads a CSV text (RFC 4180, UTF-8 with or without byte order mark, lines
/// ending in LF or CRLF) that begins with a header. The columns may come in any
/// order. `on_row` gets every row without a fault, in order; blank lines are
/// skipped. Cells are separated by commas; if the header has none, by semicolons or tabs, or by what a first line such
/// as "sep=;" says. Numbers may then have a decimal comma, as spreadsheets of many countries and R's write.csv2 write
/// them. A first column without a name holds the names of rows, as R and pandas write them: it is left out, and an
/// error (E0512) if two of its cells are alike.
///
/// @param file how diagnostics name the file.
/// @param columns those that must be there.
/// @return everything that is wrong (ids E0501 to E0512),
///         with line, column and a hint, at most 1 000 of them and 50 of one row. A fault of the header ends the
///         reading.
/// @throws std::invalid_argument if there is no column, or names are empty or repeated.
[[nodiscard]] std::vector<Diagnostic> read_csv(std::string_view text, const std::string& file,
                                               std::span<const Column> columns,
                                               const std::function<void(const CsvRow&)>& on_row,
                                               OtherColumns others = OtherColumns::kReject);

/// The names of the columns, as text columns, of a CSV text whose columns are not known beforehand; without those of
/// rows.
/// @throws kith::Error (kInvalidInput) if the header is missing, damaged or names a column twice or not at all.
[[nodiscard]] std::vector<Column> read_csv_header(std::string_view text, const std::string& file);

/// The rows of a table, kept.
struct CsvTable {
  std::vector<std::vector<TableCell>> rows;  ///< Shape [rows][columns].
  std::vector<std::size_t> lines;            ///< Where each row begins, from 1.
};

/// The whole file. @throws kith::Error (kInvalidInput) with all diagnostics, or (kIo) if it cannot be read.
[[nodiscard]] CsvTable read_csv_file(const std::filesystem::path& path, std::span<const Column> columns,
                                     OtherColumns others = OtherColumns::kReject);

}  // namespace kith
