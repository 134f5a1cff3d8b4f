#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/files/csv_reader.hpp"

namespace kith::detail {

// A row of a table that may have more columns than we know.
class OpenRow {
 public:
  OpenRow(const CsvRow& row, const std::map<std::string, std::size_t>& positions) : row_{row}, positions_{positions} {}

  [[nodiscard]] std::size_t line() const { return row_.line; }
  // The cell's value; nothing if it, or its column, is missing.
  [[nodiscard]] std::optional<std::string> text(const std::string& column) const { return get<std::string>(column); }
  [[nodiscard]] std::optional<std::int64_t> integer(const std::string& column) const {
    return get<std::int64_t>(column);
  }
  [[nodiscard]] std::optional<double> real(const std::string& column) const { return get<double>(column); }
  [[nodiscard]] std::optional<bool> boolean(const std::string& column) const { return get<bool>(column); }

 private:
  template <typename Value>
  [[nodiscard]] std::optional<Value> get(const std::string& column) const {
    const auto found = positions_.find(column);
    const auto* value = found == positions_.end() ? nullptr : std::get_if<Value>(&row_.cells[found->second]);
    return value == nullptr ? std::nullopt : std::optional{*value};
  }

  const CsvRow& row_;
  const std::map<std::string, std::size_t>& positions_;
};

// Reads a CSV file whose header must hold the required columns and may hold any others: the optional ones are read
// with their type, unknown ones are passed over.
// Faults are added to `diagnostics`. @throws kith::Error (kIo).
void read_open_csv(const std::filesystem::path& path, std::vector<Column> required, std::vector<Column> optional,
                   std::vector<Diagnostic>& diagnostics, const std::function<void(const OpenRow&)>& on_row);

// @throws kith::Error with the diagnostics if one of them is an error.
void throw_if_errors(const std::vector<Diagnostic>& diagnostics);

[[nodiscard]] Diagnostic fault(std::string id, std::string message, const std::filesystem::path& file, std::size_t line,
                               std::string hint = {});
[[nodiscard]] Diagnostic note(std::string id, std::string message, const std::filesystem::path& file, std::size_t line,
                              std::string hint = {});

}  // namespace kith::detail
