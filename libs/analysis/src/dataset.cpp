#include "kith/analysis/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "kith/core/diagnostic.hpp"
#include "kith/core/error.hpp"
#include "kith/core/memory.hpp"
#include "kith/core/text.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/files/table_text.hpp"

namespace kith {
namespace {

constexpr std::size_t kMaxDiagnostics = 20;
constexpr std::size_t kMostListed = 20;      // names of columns in a message
constexpr std::size_t kMostDistinct = 20;    // values of a column in a message
constexpr std::size_t kLongestListed = 40;   // bytes of one of them
constexpr std::uint64_t kBytesPerCell = 60;  // with what vectors keep free; longer texts have their length besides

MemoryGuard guard_of(const std::string& file) {
  return {"keeping the table " + file, "keep only the rows and columns that are needed"};
}

std::optional<double> number_of(const std::string& cell, bool decimal_comma) {
  if (const auto truth = truth_of(cell)) return *truth ? 1.0 : 0.0;
  const auto text = decimal_comma ? with_decimal_point(cell) : cell;
  double value = 0.0;
  const auto* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Cut between characters.
std::string shortened(const std::string& name) {
  if (name.size() <= kLongestListed) return name;
  auto end = kLongestListed;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end) + "...";
}

std::string listed_names(const std::vector<std::string>& names) {
  const auto list = joined(std::span{names}.first(std::min(names.size(), kMostListed)), ", ", shortened);
  return names.size() <= kMostListed ? list : list + " and " + std::to_string(names.size() - kMostListed) + " more";
}

// "1e+200": the power of ten next to a value.
std::string power_of_ten(double value) { return fmt::format("{:.0e}", std::pow(10.0, std::round(std::log10(value)))); }

}  // namespace

RowFilter parse_row_filter(std::string_view text) {
  const auto sign = text.find('=');
  const bool differs = sign != std::string_view::npos && sign > 0 && text[sign - 1] == '!';
  const auto column = text.substr(0, differs ? sign - 1 : sign);
  if (sign == std::string_view::npos || column.empty())
    throw Error{ErrorKind::kUsage,
                "'" + std::string{text} + "' is not a condition; write COLUMN=VALUE or COLUMN!=VALUE"};
  return {std::string{column}, !differs, std::string{text.substr(sign + 1)}};
}

Dataset Dataset::parse(std::string_view text, const std::string& file, std::span<const std::string> wanted) {
  Dataset data;
  data.file_ = file;

  std::vector<Column> columns;
  if (wanted.empty()) {
    columns = read_csv_header(text, file);
  } else {
    for (const auto& name : wanted) columns.push_back({.name = name});
  }
  for (const auto& column : columns) data.columns_.push_back(column.name);
  data.cells_.resize(columns.size());
  data.kinds_.resize(columns.size());

  auto guard = guard_of(file);
  const auto keep = [&](const CsvRow& row) {
    guard.take(row.cells.size() * kBytesPerCell + row.text.size());
    data.lines_.push_back(row.line);
    data.decimal_comma_ = row.separator != ',';
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      const auto* const value = std::get_if<std::string>(&row.cells[c]);
      const bool missing = value == nullptr || value->empty() || *value == "NA";
      data.cells_[c].push_back(missing ? std::nullopt : std::optional{*value});
    }
  };

  auto diagnostics = read_csv(text, file, columns, keep, OtherColumns::kIgnore);
  if (!diagnostics.empty()) throw Error{std::move(diagnostics)};
  return data;
}

Dataset Dataset::read(const std::filesystem::path& path, std::span<const std::string> wanted) {
  return parse(read_table_text(path), path.string(), wanted);
}

bool Dataset::has(std::string_view column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::size_t Dataset::index_of(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  const auto nearest = nearest_word(std::string{column}, columns_);
  throw Error{{Diagnostic{
      .id = "E0901",
      .message = "there is no column '" + std::string{column} + "'",
      .file = file_,
      .line = 1,
      .column = 1,
      .hint = nearest.empty() ? "the columns are " + listed_names(columns_) : "did you mean '" + nearest + "'?"}}};
}

const std::vector<std::optional<std::string>>& Dataset::cells(std::string_view column) const {
  return cells_[index_of(column)];
}

std::optional<std::string> Dataset::with_points(std::string_view column, std::size_t row) const {
  const auto& cell = cells(column).at(row);
  if (!cell || !decimal_comma_ || truth_of(*cell)) return cell;
  return number_of(*cell, true) ? with_decimal_point(*cell) : cell;
}

std::vector<std::optional<double>> Dataset::numbers(std::string_view column) const {
  const auto& texts = cells(column);
  std::vector<std::optional<double>> values(texts.size());
  std::vector<Diagnostic> diagnostics;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!texts[i]) continue;
    values[i] = number_of(*texts[i], decimal_comma_);
    if (values[i] || diagnostics.size() == kMaxDiagnostics) continue;
    diagnostics.push_back({.id = "E0902",
                           .message = "'" + *texts[i] + "' in column '" + std::string{column} + "' is not a number",
                           .file = file_,
                           .line = lines_[i],
                           .column = 1,
                           .hint = "write a number with a decimal point; leave the cell empty if there is none"});
  }
  if (diagnostics.empty()) return values;
  if (std::none_of(values.begin(), values.end(), [](const auto& value) { return value.has_value(); })) {
    diagnostics.resize(1);  // a column of text: one complaint says it all
    const auto text = std::find_if(texts.begin(), texts.end(), [](const auto& cell) { return cell.has_value(); });
    diagnostics.front().message =
        "column '" + std::string{column} + "' holds text, such as '" + **text + "', no numbers";
    std::set<std::string> distinct;
    for (const auto& cell : texts) {
      if (cell && distinct.size() < 3) distinct.insert(*cell);
    }
    diagnostics.front().hint = "choose a column of numbers";
    if (distinct.size() == 2)
      diagnostics.front().hint += ", or write 0 and 1 (or false and true) instead of '" + *distinct.begin() +
                                  "' and '" + *distinct.rbegin() + "'";
  }
  throw Error{std::move(diagnostics)};
}

Factor Dataset::factor(std::string_view column) const {
  const auto& texts = cells(column);
  std::vector<std::string> values;
  values.reserve(texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!texts[i]) refuse_missing(column, i);
    values.push_back(*texts[i]);
  }
  return make_factor(std::string{column}, values);
}

std::vector<double> Dataset::required_numbers(std::string_view column) const {
  const auto known = numbers(column);
  std::vector<double> values;
  values.reserve(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i]) refuse_missing(column, i);
    values.push_back(*known[i]);
  }
  return values;
}

void Dataset::refuse_missing(std::string_view column, std::size_t row) const {
  throw Error{{Diagnostic{.id = "E0903",
                          .message = "the cell in column '" + std::string{column} + "' is missing",
                          .file = file_,
                          .line = lines_[row],
                          .column = 1,
                          .hint = "fill the cell, or leave the row out"}}};
}

bool Dataset::has_numbers_only(std::string_view column) const {
  return std::ranges::all_of(
      cells(column), [&](const auto& cell) { return !cell || (!truth_of(*cell) && number_of(*cell, decimal_comma_)); });
}

ColumnKind Dataset::kind(std::string_view column) const { return kinds_[index_of(column)]; }

void Dataset::set_kind(std::string_view column, ColumnKind kind) { kinds_[index_of(column)] = kind; }

void Dataset::describe(const TableDescription& table) {
  for (const auto& column : table.columns) {
    if (column.kind != ColumnKind::kUnspecified && has(column.name)) set_kind(column.name, column.kind);
  }
}

Dataset Dataset::where(std::span<const RowFilter> filters) const {
  std::vector<std::size_t> rows;
  std::vector<std::size_t> columns;
  for (const auto& filter : filters) columns.push_back(index_of(filter.column));
  for (std::size_t i = 0; i < num_rows(); ++i) {
    bool keep = true;
    for (std::size_t f = 0; f < filters.size(); ++f) {
      keep = keep && (cells_[columns[f]][i].value_or("") == filters[f].value) == filters[f].equal;
    }
    if (keep) rows.push_back(i);
  }
  if (rows.empty() && num_rows() > 0) refuse_filters(filters);
  return select(rows);
}

void Dataset::refuse_filters(std::span<const RowFilter> filters) const {
  Diagnostic nothing{.id = "E0909", .file = file_, .infeasible = true};
  for (const auto& filter : filters) {
    const auto& texts = cells(filter.column);
    const auto passes = [&](const auto& cell) { return (cell.value_or("") == filter.value) == filter.equal; };
    if (std::any_of(texts.begin(), texts.end(), passes)) continue;

    // This condition alone leaves no row.
    nothing.message = "no row has " + filter.column + (filter.equal ? "=" : "!=") + filter.value;

    std::vector<std::string> values;
    bool any_missing = false;
    for (const auto& cell : texts) {
      any_missing = any_missing || !cell;
      if (cell && values.size() <= kMostDistinct && std::find(values.begin(), values.end(), *cell) == values.end())
        values.push_back(*cell);
    }

    const auto nearest = filter.equal ? nearest_word(filter.value, values) : std::string{};
    const bool many = values.size() > kMostDistinct;
    if (many) values.resize(kMostDistinct);
    nothing.hint = values.empty()
                       ? "every cell of column '" + filter.column + "' is empty"
                       : "column '" + filter.column + "' has " +
                             (values.size() == 1 ? "only the value " : "the values ") + listed_names(values) +
                             (many ? " and others" : "") + (any_missing ? ", and empty cells" : "") +
                             (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
    throw Error{{std::move(nothing)}};
  }

  nothing.message = "no row satisfies all conditions together";
  nothing.hint = "leave one of them out";
  throw Error{{std::move(nothing)}};
}

Dataset Dataset::complete(std::span<const std::string> columns) const {
  std::vector<std::size_t> rows;
  std::vector<std::size_t> wanted;
  for (const auto& column : columns) wanted.push_back(index_of(column));
  for (std::size_t i = 0; i < num_rows(); ++i) {
    const auto has_value = [&](std::size_t column) { return cells_[column][i].has_value(); };
    if (std::all_of(wanted.begin(), wanted.end(), has_value)) rows.push_back(i);
  }
  return select(rows);
}

Dataset Dataset::select(const std::vector<std::size_t>& rows) const {
  Dataset part;
  part.file_ = file_;
  part.columns_ = columns_;
  part.kinds_ = kinds_;
  part.decimal_comma_ = decimal_comma_;
  part.cells_.resize(cells_.size());
  auto guard = guard_of(file_);
  guard.take(cells_.size() * rows.size() * kBytesPerCell);
  for (const auto row : rows) part.lines_.push_back(lines_[row]);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    part.cells_[c].reserve(rows.size());
    for (const auto row : rows) part.cells_[c].push_back(cells_[c][row]);
  }
  return part;
}

void check_sizes(const Dataset& data, const std::string& column) {
  constexpr double kSmallest = 1e-100, kLargest = 1e100;  // of the largest value
  const auto numbers = data.numbers(column);
  double largest = 0.0;
  std::size_t row = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double size = std::abs(numbers[i].value_or(0.0));
    if (size <= largest) continue;
    largest = size;
    row = i;
  }
  if (largest == 0.0 || (largest >= kSmallest && largest <= kLargest)) return;
  throw Error{
      {Diagnostic{.id = "E0911",
                  .message = fmt::format("{:g} in column '{}' is too {} for a variance to be computed", *numbers[row],
                                         column, largest > kLargest ? "large" : "small"),
                  .file = data.file(),
                  .line = data.line(row),
                  .column = 1,
                  .hint = fmt::format("divide the column by {}, which changes no test", power_of_ten(largest))}}};
}

}  // namespace kith
