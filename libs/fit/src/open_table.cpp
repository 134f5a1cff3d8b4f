#include "open_table.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/table_text.hpp"

namespace kith::detail {
namespace {

Diagnostic diagnostic(Severity severity, std::string id, std::string message, const std::filesystem::path& file,
                      std::size_t line, std::string hint) {
  Diagnostic result;
  result.severity = severity;
  result.id = std::move(id);
  result.message = std::move(message);
  result.file = file.string();
  result.line = line;
  result.column = line > 0 ? 1 : 0;
  result.hint = std::move(hint);
  return result;
}

}  // namespace

const TableCell* OpenRow::cell(const std::string& column) const {
  const auto it = positions_.find(column);
  return it == positions_.end() ? nullptr : &row_.cells[it->second];
}

std::optional<std::string> OpenRow::text(const std::string& column) const {
  const auto* value = cell(column);
  const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(value);
  return text == nullptr ? std::nullopt : std::optional{*text};
}

std::optional<std::int64_t> OpenRow::integer(const std::string& column) const {
  const auto* value = cell(column);
  const auto* number = value == nullptr ? nullptr : std::get_if<std::int64_t>(value);
  return number == nullptr ? std::nullopt : std::optional{*number};
}

std::optional<double> OpenRow::real(const std::string& column) const {
  const auto* value = cell(column);
  const auto* number = value == nullptr ? nullptr : std::get_if<double>(value);
  return number == nullptr ? std::nullopt : std::optional{*number};
}

std::optional<bool> OpenRow::boolean(const std::string& column) const {
  const auto* value = cell(column);
  const auto* flag = value == nullptr ? nullptr : std::get_if<bool>(value);
  return flag == nullptr ? std::nullopt : std::optional{*flag};
}

void read_open_csv(const std::filesystem::path& path, std::vector<Column> required, std::vector<Column> optional,
                   std::vector<Diagnostic>& diagnostics, const std::function<void(const OpenRow&)>& on_row) {
  read_open_csv(read_table_text(path), path.string(), std::move(required), std::move(optional), diagnostics, on_row);
}

void read_open_csv(const std::string& content, const std::string& name, std::vector<Column> required,
                   std::vector<Column> optional, std::vector<Diagnostic>& diagnostics,
                   const std::function<void(const OpenRow&)>& on_row) {
  std::vector<Column> columns = std::move(required);
  for (const auto& present : read_csv_header(content, name)) {
    const auto same = [&](const Column& column) { return column.name == present.name; };
    const auto it = std::find_if(optional.begin(), optional.end(), same);
    if (it != optional.end()) columns.push_back(*it);
  }
  std::map<std::string, std::size_t> positions;
  for (std::size_t i = 0; i < columns.size(); ++i) positions[columns[i].name] = i;
  const auto faults = read_csv(
      content, name, columns,
      [&](const CsvRow& row) {
        on_row(OpenRow{row, positions});
      },
      OtherColumns::kIgnore);
  diagnostics.insert(diagnostics.end(), faults.begin(), faults.end());
}

void throw_if_errors(const std::vector<Diagnostic>& diagnostics) {
  if (has_errors(diagnostics)) throw Error{diagnostics};
}

Diagnostic fault(std::string id, std::string message, const std::filesystem::path& file, std::size_t line,
                 std::string hint) {
  return diagnostic(Severity::kError, std::move(id), std::move(message), file, line, std::move(hint));
}

Diagnostic note(std::string id, std::string message, const std::filesystem::path& file, std::size_t line,
                std::string hint) {
  return diagnostic(Severity::kWarning, std::move(id), std::move(message), file, line, std::move(hint));
}

}  // namespace kith::detail
