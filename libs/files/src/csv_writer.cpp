#include "kith/files/csv_writer.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "check_columns.hpp"

namespace kith {
namespace {

constexpr std::size_t kPiece = 64 * 1024;

template <typename Number>
void append_number(std::string& out, Number value) {
  std::array<char, 32> digits;  // the longest double has 24 characters
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

// Quoted if it would otherwise not be one cell, not the same text, or missing.
// Blanks at an end are quoted too, because many readers strip them.
void append_text(std::string& out, std::string_view text) {
  const bool plain = !text.empty() && text.find_first_of(",\"\r\n") == std::string_view::npos && text.front() != ' ' &&
                     text.front() != '\t' && text.back() != ' ' && text.back() != '\t';
  if (plain) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

}  // namespace

CsvWriter::CsvWriter(std::vector<Column> columns, Sink sink) : columns_{std::move(columns)}, sink_{std::move(sink)} {
  detail::check_columns(columns_, "CsvWriter");
  buffer_.reserve(kPiece + 4096);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) buffer_ += ',';
    append_text(buffer_, columns_[i].name);
  }
  buffer_ += '\n';
}

void CsvWriter::refuse(const std::string& problem) const {
  const std::string place = next_ < columns_.size() ? "column \"" + columns_[next_].name + "\"" : "the end of the row";
  throw std::invalid_argument("CsvWriter: row " + std::to_string(num_rows_ + 1) + ", " + place + ": " + problem);
}

void CsvWriter::begin_cell() {
  if (next_ == columns_.size()) refuse("the row has a cell too many");
  if (next_ > 0) buffer_ += ',';
}

void CsvWriter::begin_cell(ColumnType type) {
  if (next_ < columns_.size() && columns_[next_].type != type) {
    refuse("expected " + std::string{to_string(columns_[next_].type)} + ", got " + std::string{to_string(type)});
  }
  begin_cell();
}

CsvWriter& CsvWriter::text(std::string_view value) {
  if (value.find('\0') != std::string_view::npos) refuse("the text holds a zero byte");
  begin_cell(ColumnType::kText);
  append_text(buffer_, value);
  ++next_;
  return *this;
}

CsvWriter& CsvWriter::integer(std::int64_t value) {
  begin_cell(ColumnType::kInteger);
  append_number(buffer_, value);
  ++next_;
  return *this;
}

CsvWriter& CsvWriter::real(double value) {
  if (std::isnan(value)) refuse("NaN is no value");
  begin_cell(ColumnType::kReal);
  append_number(buffer_, value);
  ++next_;
  return *this;
}

CsvWriter& CsvWriter::boolean(bool value) {
  begin_cell(ColumnType::kBoolean);
  buffer_ += value ? "true" : "false";
  ++next_;
  return *this;
}

CsvWriter& CsvWriter::missing() {
  if (next_ < columns_.size() && columns_[next_].required) refuse("the value is required");
  if (columns_.size() == 1 && next_ == 0) refuse("a table of one column has no missing values");
  begin_cell();
  ++next_;
  return *this;
}

CsvWriter& CsvWriter::text_or_missing(const std::optional<std::string>& value) {
  return value ? text(std::string_view{*value}) : missing();
}
CsvWriter& CsvWriter::integer(std::optional<std::int64_t> value) { return value ? integer(*value) : missing(); }
CsvWriter& CsvWriter::real(std::optional<double> value) { return value ? real(*value) : missing(); }
CsvWriter& CsvWriter::boolean(std::optional<bool> value) { return value ? boolean(*value) : missing(); }

void CsvWriter::end_row() {
  if (next_ != columns_.size()) refuse("the row ends too early");
  buffer_ += '\n';
  next_ = 0;
  ++num_rows_;
  if (buffer_.size() >= kPiece) flush();
}

void CsvWriter::flush() {
  if (next_ != 0) refuse("a row is not flushed before its end");
  if (!buffer_.empty()) sink_(buffer_);
  buffer_.clear();
}

}  // namespace kith
