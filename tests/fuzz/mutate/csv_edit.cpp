#include "csv_edit.hpp"

#include <algorithm>
#include <numeric>

#include "mutate.hpp"

namespace kith::fuzzing {
namespace {

// The cells of one column after another; `kNew` is one that was not there.
constexpr std::size_t kNew = static_cast<std::size_t>(-1);

std::vector<std::size_t> changed_columns(std::size_t count, Dice& dice) {
  std::vector<std::size_t> columns(count);
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  const auto i = static_cast<std::ptrdiff_t>(dice.below(count));
  const auto j = static_cast<std::ptrdiff_t>(dice.below(count));
  switch (dice.below(16)) {
    case 0:
      columns.erase(columns.begin() + i);
      break;
    case 1:
      columns.insert(columns.begin() + j, static_cast<std::size_t>(i));
      break;
    case 2:
      columns.insert(columns.begin() + j, kNew);
      break;
    case 3:
      std::reverse(columns.begin(), columns.end());
      break;
    default:
      std::swap(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
  }
  return columns;
}

// Every row but the header gets the cell of another row in that column.
std::string with_one_value(std::string_view text, const std::vector<CsvLine>& lines, std::size_t column, Dice& dice) {
  const auto& from = dice.pick(lines);
  if (column >= from.cells.size()) return std::string{text};
  const auto value = std::string{from.cells[column].of(text)};
  std::string result{lines.front().range.of(text)};
  for (std::size_t l = 1; l < lines.size(); ++l) {
    const auto& line = lines[l];
    const auto cell = column < line.cells.size() ? line.cells[column] : Range{line.range.end, line.range.end};
    result += text.substr(line.range.begin, cell.begin - line.range.begin);
    result += value;
    result += text.substr(cell.end, line.range.end - cell.end);
  }
  return result;
}

std::string unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string{cell};
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"') ++i;
  }
  return text;
}

}  // namespace

std::string quoted_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string{text};
  std::string quoted{'"'};
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string{c};
  return quoted += '"';
}

std::string edit_columns(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  const auto lines = lines_of_csv(text);
  if (lines.empty()) return "a,b\n1,2\n";
  const auto count = lines.front().cells.size();
  if (dice.one_in(4)) return with_one_value(text, lines, dice.below(count), dice);
  const auto columns = changed_columns(count, dice);
  const auto name = vocabulary.names().empty() ? std::string{"x"} : dice.pick(vocabulary.names());
  std::string result;
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) result += ',';
      if (columns[c] == kNew) result += &line == &lines.front() ? name : std::string{"1"};
      if (columns[c] < line.cells.size()) result += line.cells[columns[c]].of(text);
    }
    result += text.substr(line.cells.back().end, line.range.end - line.cells.back().end);
  }
  return result;
}

std::optional<std::string> edit_json_cell(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  std::vector<Range> cells;
  for (const auto& line : lines_of_csv(text)) {
    for (const auto& cell : line.cells) {
      const auto start = cell.of(text).substr(0, 2);
      if (start == "\"{" || start == "\"[" || start.starts_with('{')) cells.push_back(cell);
    }
  }
  if (cells.empty()) return std::nullopt;
  const auto& cell = dice.pick(cells);
  std::string result{text.substr(0, cell.begin)};
  result += quoted_cell(mutate_json(unquoted(cell.of(text)), vocabulary, dice));
  return result += text.substr(cell.end);
}

}  // namespace kith::fuzzing
