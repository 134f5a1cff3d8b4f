#include "kith/explain/wrapped.hpp"

#include <algorithm>

namespace kith {

std::string wrapped(std::string_view text, std::size_t width, std::string_view indent, std::string_view first) {
  std::string result{first};
  std::size_t column = first.size();
  while (!text.empty()) {
    const auto end = text.find(' ');
    const auto word = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const bool has_words = result.size() > first.size();
    if (has_words && column + 1 + word.size() > width) {
      result.append("\n").append(indent);
      column = indent.size();
    } else if (has_words) {
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
  return wrapped(line.substr(begin), kTextWidth, blank + "  ", blank);
}

}  // namespace kith
