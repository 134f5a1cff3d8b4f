#include <algorithm>
#include <cctype>

#include "structure.hpp"

namespace kith::fuzzing {
namespace {

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' || c == '+';
}

// The parts of a word such as 0:(1,2): names and numbers.
void add_parts(std::string_view text, Range word, Structure& structure) {
  for (auto at = word.begin; at < word.end;) {
    const auto begin = at;
    while (at < word.end && is_word_character(text[at])) ++at;
    if (at == begin) ++at;
    const Range part{begin, at};
    structure.values.push_back({part, kind_of_word(part.of(text))});
  }
}

}  // namespace

Structure structure_of_lines(std::string_view text) {
  Structure structure;
  ItemList lines{.level = Level::kLines};
  for (std::size_t at = 0; at < text.size();) {
    const auto newline = text.find('\n', at);
    const auto end = newline == std::string_view::npos ? text.size() : newline;
    ItemList words{.level = Level::kElements, .separator = " "};
    for (auto word = at; word < end;) {
      word = std::min(end, text.find_first_not_of(" \t\r", word));
      const auto stop = std::min(end, text.find_first_of(" \t\r", word));
      if (stop > word) words.items.push_back({word, stop});
      if (stop > word) add_parts(text, {word, stop}, structure);
      word = stop;
    }
    const auto next = std::min(text.size(), end + 1);
    lines.items.push_back({at, next});
    if (!words.items.empty()) structure.lists.push_back(std::move(words));
    at = next;
  }
  structure.lists.push_back(std::move(lines));
  return structure;
}

}  // namespace kith::fuzzing
