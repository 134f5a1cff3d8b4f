#include "open_table.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/table_text.hpp"

namespace kith::detail {

void read_open_csv(const std::filesystem::path& path, std::vector<Column> required, std::vector<Column> optional,
                   std::vector<Diagnostic>& diagnostics, const std::function<void(const OpenRow&)>& on_row) {
  const auto content = read_table_text(path);
  const auto name = path.string();
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
  return {.id = std::move(id),
          .message = std::move(message),
          .file = file.string(),
          .line = line,
          .column = line > 0 ? 1u : 0u,
          .hint = std::move(hint)};
}

Diagnostic note(std::string id, std::string message, const std::filesystem::path& file, std::size_t line,
                std::string hint) {
  auto result = fault(std::move(id), std::move(message), file, line, std::move(hint));
  result.severity = Severity::kWarning;
  return result;
}

}  // namespace kith::detail
