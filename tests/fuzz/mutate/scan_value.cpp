#include <algorithm>
#include <cctype>

#include "structure.hpp"

namespace kith::fuzzing {
namespace {

constexpr std::size_t kDeepest = 64;

// Where the string that begins at `begin` ends, behind its last quote; at the end of the line if there is none.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool is_long = text.substr(begin, 3) == three;
  std::size_t at = begin + (is_long ? 3 : 1);
  while (at < text.size()) {
    if (text[at] == '\\' && quote == '"') {
      at = std::min(text.size(), at + 2);
    } else if (is_long && text.substr(at, 3) == three) {
      return at + 3;
    } else if (!is_long && text[at] == quote) {
      return at + 1;
    } else if (!is_long && text[at] == '\n') {
      return at;
    } else {
      ++at;
    }
  }
  return at;
}

// Blanks, line breaks and, in TOML, comments.
std::size_t skip_blanks(std::string_view text, std::size_t at, char assign) {
  while (at < text.size()) {
    if (assign == '=' && text[at] == '#') {
      at = std::min(text.size(), text.find('\n', at));
    } else if (std::string_view{" \t\r\n"}.find(text[at]) == std::string_view::npos) {
      break;
    } else {
      ++at;
    }
  }
  return at;
}

bool is_quote(char c) { return c == '"' || c == '\''; }

// The name of a member and what stands between it and its value.
std::size_t scan_name(std::string_view text, std::size_t at, char assign, Structure& structure) {
  const std::string ends{assign, ',', '}', '\n'};
  while (at < text.size() && ends.find(text[at]) == std::string::npos) {
    const auto begin = at;
    if (is_quote(text[at])) {
      at = end_of_string(text, at);
    } else {
      while (at < text.size() && !is_quote(text[at]) && (ends + ". \t").find(text[at]) == std::string::npos) ++at;
    }
    if (at > begin) structure.names.push_back({begin, at});
    while (at < text.size() && (text[at] == '.' || text[at] == ' ' || text[at] == '\t')) ++at;
  }
  return at < text.size() && text[at] == assign ? skip_blanks(text, at + 1, assign) : at;
}

// An array or table, from its bracket to the other.
std::size_t scan_compound(std::string_view text, std::size_t begin, char assign, Structure& structure,
                          std::size_t depth) {
  const bool is_table = text[begin] == '{';
  ItemList list{.level = is_table ? Level::kMembers : Level::kElements, .separator = ", ", .named = is_table};
  auto at = skip_blanks(text, begin + 1, assign);
  while (at < text.size() && text[at] != ']' && text[at] != '}') {
    const auto item = at;
    if (is_table) at = scan_name(text, at, assign, structure);
    if (at < text.size() && text[at] != ',' && text[at] != '}') at = scan_value(text, at, assign, structure, depth + 1);
    list.items.push_back({item, at});
    at = skip_blanks(text, at, assign);
    if (at < text.size() && text[at] == ',') at = skip_blanks(text, at + 1, assign);
    if (at == item) ++at;  // nothing that belongs here
  }
  structure.lists.push_back(std::move(list));
  return std::min(text.size(), at + 1);
}

}  // namespace

ValueKind kind_of_word(std::string_view word) {
  if (word == "true" || word == "false") return ValueKind::kBoolean;
  if (word.empty()) return ValueKind::kOther;
  const auto digits = word.find_first_not_of("+-");
  if (digits == std::string_view::npos) return ValueKind::kOther;
  if (word.find_first_not_of("0123456789", digits) == std::string_view::npos) return ValueKind::kInteger;
  const bool number = std::isdigit(static_cast<unsigned char>(word[digits])) != 0 || word[digits] == '.';
  if (number && word.find_first_not_of("0123456789.eE+-_") == std::string_view::npos) return ValueKind::kReal;
  return ValueKind::kOther;
}

std::size_t scan_value(std::string_view text, std::size_t begin, char assign, Structure& structure, std::size_t depth) {
  if (begin >= text.size()) return begin;
  const char first = text[begin];
  std::size_t end = begin;
  auto kind = ValueKind::kOther;
  if (is_quote(first)) {
    end = end_of_string(text, begin);
    kind = ValueKind::kText;
  } else if ((first == '[' || first == '{') && depth < kDeepest) {
    end = scan_compound(text, begin, assign, structure, depth);
    kind = ValueKind::kCompound;
  } else {
    end = std::min(text.size(), text.find_first_of(",]}# \t\r\n", begin));
    kind = kind_of_word(text.substr(begin, end - begin));
  }
  if (end > begin) structure.values.push_back({{begin, end}, kind});
  return end;
}

Structure structure_of_json(std::string_view text) {
  Structure structure;
  ItemList documents{.level = Level::kLines};
  for (auto at = skip_blanks(text, 0, ':'); at < text.size(); at = skip_blanks(text, at, ':')) {
    const auto begin = at;
    at = scan_value(text, at, ':', structure);
    if (at == begin) ++at;
    documents.items.push_back({begin, at});
  }
  if (documents.items.size() > 1) structure.lists.push_back(std::move(documents));
  return structure;
}

}  // namespace kith::fuzzing
