#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kith/files/column.hpp"

namespace kith {

/// Writes a table as CSV (RFC 4180, but LF ends a line; UTF-8; a header first),
/// cell by cell:
///
///   writer.text("joint").integer(3).real(0.25).missing();
///   writer.end_row();
///
/// Numbers are the shortest that read back to the same bits, in any locale. A
/// missing value is empty; an empty text is "". Text is quoted where it must be.
/// The types and the number of the cells are checked against the columns.
///
/// Rows are collected and handed to the sink in pieces of about 64 KiB, which
/// end where rows do; the last piece only by flush(). Not thread-safe.
class CsvWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// @throws std::invalid_argument if there is no column, or names are empty or repeated.
  CsvWriter(std::vector<Column> columns, Sink sink);

  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return columns_; }
  /// Rows ended so far, without the header.
  [[nodiscard]] std::size_t num_rows() const noexcept { return num_rows_; }

  // The next cell of the row.
  // Each throws std::invalid_argument if the column has another type or the row is full.

  /// @throws std::invalid_argument also if `value` holds a zero byte, which no CSV reader expects.
  CsvWriter& text(std::string_view value);
  CsvWriter& integer(std::int64_t value);
  /// Counts. @throws std::invalid_argument also from 2^63 on.
  template <std::unsigned_integral Count>
  CsvWriter& integer(Count value) {
    if (!std::in_range<std::int64_t>(value)) refuse("the number is out of range");
    return integer(static_cast<std::int64_t>(value));
  }
  /// @throws std::invalid_argument also for NaN: what is not known is missing().
  CsvWriter& real(double value);
  CsvWriter& boolean(bool value);
  /// Of any type. @throws std::invalid_argument if the column is required, or the only one (a row must not be blank).
  CsvWriter& missing();
  /// The value, or missing() without one.
  CsvWriter& text_or_missing(const std::optional<std::string>& value);
  CsvWriter& integer(std::optional<std::int64_t> value);
  CsvWriter& real(std::optional<double> value);
  CsvWriter& boolean(std::optional<bool> value);

  /// @throws std::invalid_argument unless every column has its cell.
  void end_row();

  /// Hands what is collected to the sink. @throws std::invalid_argument inside a row.
  void flush();

 private:
  void begin_cell(ColumnType type);
  void begin_cell();
  [[noreturn]] void refuse(const std::string& problem) const;

  std::vector<Column> columns_;
  Sink sink_;
  std::string buffer_;
  std::size_t next_ = 0;  // column of the next cell
  std::size_t num_rows_ = 0;
};

}  // namespace kith
