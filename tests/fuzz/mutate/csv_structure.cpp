#include <algorithm>

#include "csv_edit.hpp"

namespace kith::fuzzing {
namespace {

std::size_t end_of_cell(std::string_view text, std::size_t at) {
  bool quoted = false;
  for (; at < text.size(); ++at) {
    if (text[at] == '"') quoted = !quoted;
    if (!quoted && (text[at] == ',' || text[at] == '\n' || text[at] == '\r')) break;
  }
  return at;
}

ValueKind kind_of_cell(std::string_view cell) {
  const auto kind = kind_of_word(cell);
  return kind == ValueKind::kOther ? ValueKind::kText : kind;
}

}  // namespace

std::vector<CsvLine> lines_of_csv(std::string_view text) {
  std::vector<CsvLine> lines;
  for (std::size_t at = 0; at < text.size();) {
    CsvLine line{.range = {at, at}};
    while (true) {
      const auto end = end_of_cell(text, at);
      line.cells.push_back({at, end});
      at = end;
      if (at >= text.size() || text[at] != ',') break;
      ++at;
    }
    const auto newline = text.find('\n', at);
    at = newline == std::string_view::npos ? text.size() : newline + 1;
    line.range.end = at;
    lines.push_back(std::move(line));
  }
  return lines;
}

Structure structure_of_csv(std::string_view text) {
  Structure structure;
  ItemList rows{.level = Level::kLines};
  const auto lines = lines_of_csv(text);
  for (const auto& line : lines) {
    if (&line == &lines.front()) {
      structure.names = line.cells;
      continue;  // it stays where it is; see edit_columns()
    }
    rows.items.push_back(line.range);
    structure.lists.push_back({.level = Level::kElements, .separator = ",", .items = line.cells});
    for (const auto& cell : line.cells) structure.values.push_back({cell, kind_of_cell(cell.of(text))});
  }
  structure.lists.push_back(std::move(rows));
  return structure;
}

}  // namespace kith::fuzzing
