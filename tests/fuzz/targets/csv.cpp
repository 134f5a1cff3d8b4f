// CSV tables of four columns, one of each type. Rows that are read are written so that they read as the same rows, and
// a text with faults gives diagnostics.

#include <array>

#include "../fuzzing.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/files/csv_writer.hpp"

using namespace kith;

namespace {

using Rows = std::vector<std::vector<TableCell>>;

const std::array<Column, 4>& columns() {
  static const std::array<Column, 4> kColumns{Column{.name = "t", .type = ColumnType::kText},
                                              Column{.name = "i", .type = ColumnType::kInteger, .required = true},
                                              Column{.name = "r", .type = ColumnType::kReal},
                                              Column{.name = "b", .type = ColumnType::kBoolean}};
  return kColumns;
}

Rows rows_of(std::string_view text, OtherColumns others, std::vector<Diagnostic>& diagnostics) {
  Rows rows;
  const auto keep = [&](const CsvRow& row) { rows.emplace_back(row.cells.begin(), row.cells.end()); };
  diagnostics = read_csv(text, "table.csv", columns(), keep, others);
  return rows;
}

template <typename Value>
std::optional<Value> value(const TableCell& cell) {
  const auto* found = std::get_if<Value>(&cell);
  return found == nullptr ? std::nullopt : std::optional{*found};
}

std::string written(const Rows& rows) {
  std::string text;
  CsvWriter writer{{columns().begin(), columns().end()}, [&](std::string_view piece) { text += piece; }};
  for (const auto& row : rows) {
    writer.text_or_missing(value<std::string>(row[0])).integer(value<std::int64_t>(row[1]));
    writer.real(value<double>(row[2])).boolean(value<bool>(row[3]));
    writer.end_row();
  }
  writer.flush();
  return text;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "csv", .head_bytes = 1};

// The first byte says whether other columns are ignored.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto others = bytes.below(2) == 0 ? OtherColumns::kReject : OtherColumns::kIgnore;
  std::vector<Diagnostic> diagnostics;
  const auto rows = rows_of(bytes.rest(), others, diagnostics);
  const auto outcome = fuzzing::require_good(diagnostics, bytes.rest(), "table.csv");
  std::vector<Diagnostic> none;
  const auto text = written(rows);
  fuzzing::require(rows_of(text, OtherColumns::kReject, none) == rows && none.empty(), "rows read as written", text);
  fuzzing::reads(bytes.rest(), "table.csv", [&] {
    fuzzing::require(!read_csv_header(bytes.rest(), "table.csv").empty(), "a header names columns");
  });
  return outcome;
}
