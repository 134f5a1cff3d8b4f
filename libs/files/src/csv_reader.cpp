#include "kith/files/csv_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "check_columns.hpp"
#include "csv_records.hpp"
#include "kith/core/error.hpp"
#include "kith/core/memory.hpp"
#include "kith/core/text.hpp"
#include "kith/files/table_text.hpp"

namespace kith {
namespace {

constexpr std::size_t kMaxDiagnostics = 1000;
constexpr std::size_t kMaxDiagnosticsOfRow = 50;  // finding a cell's place takes as long as its row is
constexpr std::size_t kLongestShownLine = 2000;   // bytes; nobody looks at more
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// The number of UTF-8 characters.
std::size_t num_characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

// The length of the well-formed UTF-8 sequence at the front (Unicode, table 3-7), 0 if there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (first < 0xC2 || first > 0xF4) return 0;
  const unsigned least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < least || byte(1) > most) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
  }
  return length;
}

// A cell as messages show it, cut after 40 bytes or a little less. @pre is_text(text).
std::string shown_in_quotes(std::string_view text) {
  std::size_t shown = 0;
  while (shown < text.size() && shown < 37) shown += sequence_length(text.substr(shown));
  std::string result{'"'};
  result += text.substr(0, shown);
  result += shown < text.size() ? "...\"" : "\"";
  return result;
}

bool is_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0 || text.front() == '\0') return false;
    text.remove_prefix(length);
  }
  return true;
}

// What is wrong with a cell.
struct Fault {
  std::string id;
  std::string message;
  std::string hint;
};

struct Parsed {
  TableCell cell = {};
  std::optional<Fault> fault = {};
};

template <typename Number>
Parsed parse_number(const std::string& text, const Column& column, const std::string& example) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = end == text.data() + text.size();
  const std::string message = shown_in_quotes(text) + " in column \"" + column.name + "\" is ";
  if (error == std::errc::result_out_of_range && whole) {
    return {.fault = Fault{"E0510", message + "out of the range of a number", "use a smaller number"}};
  }
  bool valid = error == std::errc{} && whole;
  if constexpr (std::is_same_v<Number, double>) valid = valid && !std::isnan(value);
  if (valid) return {.cell = value};
  std::string hint = "write it like " + example + ", or leave the cell empty if the value is missing";
  if (text.find(',') != std::string::npos) hint = "use a decimal point, as in " + example;
  return {.fault = Fault{"E0506", message + "not of type " + std::string{to_string(column.type)}, hint}};
}

Parsed parse_cell(const std::optional<std::string>& field, const Column& column, char separator) {
  if (!field) {
    if (!column.required) return {};
    return {.fault = Fault{"E0507", "column \"" + column.name + "\" needs a value in every row", "fill the cell"}};
  }
  if (!is_text(*field)) {
    return {.fault = Fault{"E0509", "the cell in column \"" + column.name + "\" is not UTF-8 text",
                           "save the file as UTF-8"}};
  }
  switch (column.type) {
    case ColumnType::kText:
      return {.cell = *field};
    case ColumnType::kInteger:
      return parse_number<std::int64_t>(*field, column, "42");
    case ColumnType::kReal:
      return parse_number<double>(separator == ',' ? *field : with_decimal_point(*field), column, "0.5");
    case ColumnType::kBoolean:
      if (const auto truth = truth_of(*field)) return {.cell = *truth};
      return {.fault =
                  Fault{"E0506", shown_in_quotes(*field) + " in column \"" + column.name + "\" is not of type boolean",
                        "write true or false"}};
  }
  return {};
}

std::string separators(char separator) {
  return separator == ',' ? "commas" : separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : "separators";
}

// Whether the first column has no name, as R and pandas write the names of rows. No table has it as a column.
bool begins_with_row_names(const detail::CsvRecord& header) {
  return header.fields.size() > 1 && header.fields[0].value_or("").empty();
}

class Reader {
 public:
  Reader(const std::string& file, std::span<const Column> columns, const std::function<void(const CsvRow&)>& on_row,
         OtherColumns others)
      : file_{file}, columns_{columns}, on_row_{on_row}, others_{others}, cells_(columns.size()) {}

  std::vector<Diagnostic> read(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    detail::for_each_record(text, [&](const detail::CsvRecord& record) {
      if (!has_header_) return read_header(record);
      read_row(record);
      return diagnostics_.size() < kMaxDiagnostics;
    });
    if (!has_header_ && diagnostics_.empty()) {
      diagnostics_.push_back({.id = "E0501",
                              .message = "the table is empty: it has no header",
                              .file = file_,
                              .hint = "begin with a line of column names, such as " + names()});
    }
    if (diagnostics_.size() >= kMaxDiagnostics) {
      diagnostics_.resize(kMaxDiagnostics);
      diagnostics_.push_back({.id = "E0511", .message = "too many problems; the rest was not checked", .file = file_});
    }
    return std::move(diagnostics_);
  }

 private:
  [[nodiscard]] std::string names() const { return joined(columns_, ",", &Column::name); }

  void report(const detail::CsvRecord& record, std::size_t field, const Fault& fault) {
    const detail::CsvPlace place = detail::locate(record.text, field, record.separator);
    const std::string_view cell = place.line_text.substr(std::min(place.offset, place.line_text.size()), place.length);
    diagnostics_.push_back(
        {.id = fault.id,
         .message = fault.message,
         .file = file_,
         .line = record.line + place.line,
         .column = num_characters(place.line_text.substr(0, place.offset)) + 1,
         .length = std::max<std::size_t>(1, num_characters(cell)),
         .hint = fault.hint,
         .source_line = std::string{place.line_text.size() > kLongestShownLine ? "" : place.line_text}});
  }

  bool report_malformed(const detail::CsvRecord& record) {
    if (!record.malformed) return false;
    report(record, 0,
           {"E0508", "unbalanced quotes in this row",
            "put the whole cell between quotes and write a quote inside it twice"});
    return true;
  }

  // Fills source_: where each wanted column is in the file. A fault ends the reading.
  bool read_header(const detail::CsvRecord& record) {
    has_header_ = true;
    if (report_malformed(record)) return false;
    source_.assign(columns_.size(), record.fields.size());
    std::unordered_map<std::string_view, std::size_t> position;
    for (std::size_t c = 0; c < columns_.size(); ++c) position.emplace(columns_[c].name, c);
    has_row_names_ = begins_with_row_names(record);
    for (std::size_t f = has_row_names_ ? 1 : 0; f < record.fields.size() && diagnostics_.size() < kMaxDiagnosticsOfRow;
         ++f) {
      const std::string name = record.fields[f].value_or("");
      const auto column = position.find(name);
      if (column == position.end()) {
        if (others_ == OtherColumns::kReject) report_unknown(record, f, name);
        continue;
      }
      auto& source = source_[column->second];
      if (source != record.fields.size()) {
        report(record, f, {"E0504", "column " + shown_in_quotes(name) + " occurs twice", "remove one of them"});
      }
      source = f;
    }
    for (std::size_t c = 0; c < columns_.size() && diagnostics_.size() < kMaxDiagnosticsOfRow; ++c) {
      if (source_[c] != record.fields.size()) continue;
      report(record, 0, {"E0502", "column \"" + columns_[c].name + "\" is missing", missing_hint(record, columns_[c])});
    }
    num_fields_ = record.fields.size();
    return diagnostics_.empty();
  }

  // Where other columns are ignored, the missing one may be there under a misspelt name.
  [[nodiscard]] std::string missing_hint(const detail::CsvRecord& record, const Column& missing) const {
    if (others_ == OtherColumns::kReject) return "the columns are " + names();
    std::vector<std::string> found;
    for (const auto& field : record.fields) {
      if (field && is_text(*field)) found.push_back(*field);
    }
    const auto nearest = nearest_word(missing.name, found);
    return nearest.empty() ? "the file has " + joined(found) : "did you mean " + nearest + "?";
  }

  void report_unknown(const detail::CsvRecord& record, std::size_t field, const std::string& name) {
    if (!is_text(name)) {
      report(record, field, {"E0509", "the name of a column is not UTF-8 text", "save the file as UTF-8"});
      return;
    }
    std::vector<std::string> known;
    for (const Column& column : columns_) known.push_back(column.name);
    const std::string nearest = nearest_word(name, known);
    report(record, field,
           {"E0503", "unknown column " + shown_in_quotes(name),
            nearest.empty() ? "remove it; the columns are " + names() : "did you mean " + nearest + "?"});
  }

  void read_row(const detail::CsvRecord& record) {
    if (report_malformed(record)) return;
    if (record.fields.size() != num_fields_) {
      report(
          record, std::min(num_fields_, record.fields.size()),
          {"E0505",
           "the row has " + std::to_string(record.fields.size()) + " cells, the header " + std::to_string(num_fields_),
           "put text with " + separators(record.separator) + " in quotes, and keep the " +
               separators(record.separator) + " around empty cells"});
      return;
    }
    const std::size_t before = diagnostics_.size();
    if (has_row_names_ && !row_names_.insert(std::hash<std::string>{}(record.fields[0].value_or(""))).second) {
      report(record, 0,
             {"E0512", "column 1 has no name, and does not name the rows: this cell occurs twice", "name the column"});
    }
    for (std::size_t c = 0; c < columns_.size() && diagnostics_.size() < before + kMaxDiagnosticsOfRow; ++c) {
      Parsed parsed = parse_cell(record.fields[source_[c]], columns_[c], record.separator);
      if (parsed.fault) {
        report(record, source_[c], *parsed.fault);
      } else {
        cells_[c] = std::move(parsed.cell);
      }
    }
    if (diagnostics_.size() == before) on_row_({record.line, cells_, record.text, source_, record.separator});
  }

  const std::string& file_;
  std::span<const Column> columns_;
  const std::function<void(const CsvRow&)>& on_row_;
  OtherColumns others_;
  std::vector<TableCell> cells_;
  std::vector<std::size_t> source_;
  std::size_t num_fields_ = 0;
  bool has_header_ = false;
  bool has_row_names_ = false;
  std::unordered_set<std::size_t> row_names_;  // hashes of those that occurred
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace

std::string with_decimal_point(std::string text) {
  const auto comma = text.find(',');
  if (comma == text.find_first_of(",.") && comma == text.find_last_of(",.") && comma != std::string::npos)
    text[comma] = '.';
  return text;
}

std::optional<bool> truth_of(std::string_view text) {
  if (text == "true" || text == "TRUE" || text == "True") return true;
  if (text == "false" || text == "FALSE" || text == "False") return false;
  return std::nullopt;
}

std::string_view CsvRow::written(std::size_t column) const {
  if (column >= fields.size()) throw std::out_of_range{"CsvRow::written: there is no such column"};
  const detail::CsvPlace place = detail::locate(text, fields[column], separator);
  const auto begin = static_cast<std::size_t>(place.line_text.data() - text.data()) + place.offset;
  const bool empty = begin >= text.size() || text[begin] == separator || text[begin] == '\r' || text[begin] == '\n';
  return text.substr(begin, empty ? 0 : place.length);
}

std::vector<Diagnostic> read_csv(std::string_view text, const std::string& file, std::span<const Column> columns,
                                 const std::function<void(const CsvRow&)>& on_row, OtherColumns others) {
  detail::check_columns(columns, "read_csv");
  return Reader{file, columns, on_row, others}.read(text);
}

std::vector<Column> read_csv_header(std::string_view text, const std::string& file) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<Column> columns;
  std::vector<Diagnostic> diagnostics;
  const auto report = [&](const std::string& id, const std::string& message, const std::string& hint) {
    diagnostics.push_back({.id = id, .message = message, .file = file, .line = 1, .column = 1, .hint = hint});
  };
  bool found = false;
  std::unordered_set<std::string> names;
  detail::for_each_record(text, [&](const detail::CsvRecord& record) {
    found = true;
    if (record.malformed) {
      report("E0508", "unbalanced quotes in the header",
             "put the whole name between quotes and write a quote inside it twice");
    }
    for (std::size_t f = begins_with_row_names(record) ? 1 : 0; f < record.fields.size(); ++f) {
      if (diagnostics.size() >= kMaxDiagnosticsOfRow) break;
      const auto name = record.fields[f].value_or("");
      if (name.empty()) {
        report("E0512", "column " + std::to_string(f + 1) + " has no name", "name every column");
      } else if (!is_text(name)) {
        report("E0509", "the name of a column is not UTF-8 text", "save the file as UTF-8");
      } else if (!names.insert(name).second) {
        report("E0504", "column " + shown_in_quotes(name) + " occurs twice", "remove one of them");
      }
      columns.push_back({.name = name});
    }
    return false;
  });
  if (!found) report("E0501", "the table is empty: it has no header", "begin with a line of column names");
  if (!diagnostics.empty()) throw Error{std::move(diagnostics)};
  return columns;
}

CsvTable read_csv_file(const std::filesystem::path& path, std::span<const Column> columns, OtherColumns others) {
  const std::string text = read_table_text(path);
  CsvTable table;
  MemoryGuard guard{"keeping the table " + path.string(), "keep only the rows and columns that are needed"};
  const auto keep = [&](const CsvRow& row) {
    guard.take(row.cells.size() * sizeof(TableCell) + row.text.size());
    table.rows.emplace_back(row.cells.begin(), row.cells.end());
    table.lines.push_back(row.line);
  };
  auto diagnostics = read_csv(text, path.string(), columns, keep, others);
  if (!diagnostics.empty()) throw Error{std::move(diagnostics)};
  return table;
}

}  // namespace kith
