#include "kith/explain/wrapped.hpp"

#include <algorithm>

namespace kith {

std::string wrapped(std::string_view text, std::size_t width, std::string_view indent) {
  std::string result;
  std::size_t column = 0;
  while (!text.empty()) {
    const auto end = text.find(' ');
    const auto word = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (column > 0 && column + 1 + word.size() > width) {
      result.append("\n").append(indent);
      column = indent.size();
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string wrapped_line(std::string_view line) {
  if (line.size() <= kTextWidth) return std::string{line};
  const auto begin = std::min(line.find_first_not_of(' '), line.size());
  const std::string blank(begin, ' ');
  return blank + wrapped(line.substr(begin), kTextWidth - begin, blank + "  ");
}

}  // namespace kith
