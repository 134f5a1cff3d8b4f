#include <algorithm>

#include "structure.hpp"

namespace kith::fuzzing {
namespace {

std::size_t end_of_line(std::string_view text, std::size_t at) {
  const auto end = text.find('\n', at);
  return end == std::string_view::npos ? text.size() : end + 1;
}

// The names in the header of a table, which begins at `at`.
void scan_header(std::string_view text, std::size_t at, std::size_t end, Structure& structure) {
  while (at < end) {
    at = std::min(end, text.find_first_not_of("[]. \t\r\n", at));
    const auto stop = std::min(end, text.find_first_of("[]. \t\r\n", at));
    if (stop > at) structure.names.push_back({at, stop});
    at = stop;
  }
}

// A line that is no header: names, the equals sign, a value which may take more lines. Returns where it ends.
std::size_t scan_statement(std::string_view text, std::size_t at, Structure& structure) {
  while (at < text.size() && text[at] != '=' && text[at] != '\n' && text[at] != '#') {
    const auto end = std::min(text.size(), text.find_first_of(".= \t\r\n#", at));
    if (end > at) structure.names.push_back({at, end});
    at = end;
    while (at < text.size() && (text[at] == '.' || text[at] == ' ' || text[at] == '\t' || text[at] == '\r')) ++at;
  }
  if (at >= text.size() || text[at] != '=') return end_of_line(text, at);
  at = std::min(text.size(), text.find_first_not_of(" \t", at + 1));
  if (at < text.size() && text[at] != '\n') at = scan_value(text, at, '=', structure);
  return end_of_line(text, at);
}

}  // namespace

Structure structure_of_toml(std::string_view text) {
  Structure structure;
  ItemList sections{.level = Level::kSections, .named = true};
  ItemList lines{.level = Level::kLines, .named = true};
  std::size_t section = 0;
  const auto end_section = [&](std::size_t at) {
    if (at > section) sections.items.push_back({section, at});
    if (!lines.items.empty()) structure.lists.push_back(std::move(lines));
    lines = {.level = Level::kLines, .named = true};
    section = at;
  };
  for (std::size_t at = 0; at < text.size();) {
    const auto begin = at;
    const auto first = std::min(text.size(), text.find_first_not_of(" \t", at));
    if (first < text.size() && text[first] == '[') {
      end_section(begin);
      at = end_of_line(text, first);
      scan_header(text, first, at, structure);
    } else {
      at = scan_statement(text, first, structure);
      lines.items.push_back({begin, at});
    }
  }
  end_section(text.size());
  structure.lists.push_back(std::move(sections));
  return structure;
}

}  // namespace kith::fuzzing
