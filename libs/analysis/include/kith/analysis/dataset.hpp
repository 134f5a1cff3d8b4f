#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/analysis/factor.hpp"
#include "kith/files/codebook.hpp"

namespace kith {

/// Rows to keep: those whose cell equals, or differs from, a value.
struct RowFilter {
  std::string column;
  bool equal = true;
  std::string value;
};
/// Reads "COLUMN=VALUE" or "COLUMN!=VALUE". @throws kith::Error (kUsage) for anything else.
[[nodiscard]] RowFilter parse_row_filter(std::string_view text);

/// A tidy table: one observation per row, one variable per column. Cells are
/// text until somebody asks for numbers; empty cells and "NA" are missing.
class Dataset {
 public:
  /// @param wanted  columns to keep; empty: all of them.
  /// @throws kith::Error (kInvalidInput) with file and row of everything that is wrong; kIo.
  [[nodiscard]] static Dataset parse(std::string_view text, const std::string& file,
                                     std::span<const std::string> wanted = {});
  [[nodiscard]] static Dataset read(const std::filesystem::path& path, std::span<const std::string> wanted = {});

  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }
  [[nodiscard]] bool has(std::string_view column) const;
  [[nodiscard]] std::size_t num_rows() const noexcept { return lines_.size(); }
  /// Where row i begins in the file, from 1.
  [[nodiscard]] std::size_t line(std::size_t i) const { return lines_.at(i); }

  /// A cell of a column as text, numbers with decimal points whatever the file has. @throws as cells() does.
  [[nodiscard]] std::optional<std::string> with_points(std::string_view column, std::size_t row) const;
  /// The cells of a column. @throws kith::Error (kInvalidInput, E0901) if there is no such column.
  [[nodiscard]] const std::vector<std::optional<std::string>>& cells(std::string_view column) const;
  /// The same as numbers; true and false are 1 and 0.
  /// @throws kith::Error (kInvalidInput, E0902) that names file, row and column of every text.
  [[nodiscard]] std::vector<std::optional<double>> numbers(std::string_view column) const;
  /// The same of a column in which every row has a value. @throws also (E0903) for a missing cell.
  [[nodiscard]] std::vector<double> required_numbers(std::string_view column) const;
  /// Whether each cell is missing or a number; true and false are none. @throws as cells() does.
  [[nodiscard]] bool has_numbers_only(std::string_view column) const;
  /// The column as a factor, levels in the order of appearance. @throws also (E0903) for a missing cell.
  [[nodiscard]] Factor factor(std::string_view column) const;

  /// What the values of a column stand for: unspecified unless somebody said so. @throws as cells() does.
  [[nodiscard]] ColumnKind kind(std::string_view column) const;
  void set_kind(std::string_view column, ColumnKind kind);
  /// Takes over the kinds of a codebook's columns, as far as the table has them.
  void describe(const TableDescription& table);

  /// The rows that pass all filters. @throws as cells() does, and kith::Error (kInfeasible, E0909) with the values that
  /// the column has if no row passes.
  [[nodiscard]] Dataset where(std::span<const RowFilter> filters) const;
  /// The rows in which every one of the columns has a value.
  [[nodiscard]] Dataset complete(std::span<const std::string> columns) const;

 private:
  [[nodiscard]] std::size_t index_of(std::string_view column) const;
  [[nodiscard]] Dataset select(const std::vector<std::size_t>& rows) const;
  [[noreturn]] void refuse_missing(std::string_view column, std::size_t row) const;
  [[noreturn]] void refuse_filters(std::span<const RowFilter> filters) const;

  std::string file_;
  std::vector<std::string> columns_;
  std::vector<ColumnKind> kinds_;
  std::vector<std::vector<std::optional<std::string>>> cells_;  // shape [columns][rows]
  std::vector<std::size_t> lines_;
  bool decimal_comma_ = false;  // commas do not separate the cells
};

/// Values whose squares leave the range of numbers are refused: nothing about their variances could be computed.
/// @throws kith::Error (kInvalidInput, E0911) with file and row.
void check_sizes(const Dataset& data, const std::string& column);

}  // namespace kith
