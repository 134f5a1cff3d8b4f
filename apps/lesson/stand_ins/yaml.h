#pragma once

// In place of LibYAML, which Debian has compiled for another machine: as much of it as libs/maps uses. It reads the
// flat tables that map_server writes, a key and a value per line, of which one is a list in brackets; `kith lesson` has
// read the file with LibYAML before, so what is not of this form is refused here.

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

enum yaml_event_type_t {
  YAML_NO_EVENT,
  YAML_STREAM_START_EVENT,
  YAML_STREAM_END_EVENT,
  YAML_DOCUMENT_START_EVENT,
  YAML_DOCUMENT_END_EVENT,
  YAML_ALIAS_EVENT,
  YAML_SCALAR_EVENT,
  YAML_SEQUENCE_START_EVENT,
  YAML_SEQUENCE_END_EVENT,
  YAML_MAPPING_START_EVENT,
  YAML_MAPPING_END_EVENT
};
enum yaml_encoding_t { YAML_UTF8_ENCODING };

struct yaml_mark_t {
  std::size_t line = 0, column = 0;
};

struct yaml_event_t {
  yaml_event_type_t type = YAML_NO_EVENT;
  yaml_mark_t start_mark;
  std::string text;
  struct {
    struct {
      unsigned char* value;
      std::size_t length;
    } scalar;
  } data;
};

struct yaml_parser_t {
  std::vector<yaml_event_t> events;
  std::size_t next = 0;
  const char* problem = nullptr;
  yaml_mark_t problem_mark;
};

inline int yaml_parser_initialize(yaml_parser_t* parser) {
  *parser = {};
  return 1;
}
inline void yaml_parser_delete(yaml_parser_t*) {}
inline void yaml_event_delete(yaml_event_t*) {}
inline void yaml_parser_set_encoding(yaml_parser_t*, yaml_encoding_t) {}

namespace kith::detail {

inline void add_event(yaml_parser_t& parser, yaml_event_type_t type, yaml_mark_t mark, std::string_view text = {}) {
  parser.events.push_back({type, mark, std::string{text}, {}});
}

// Without spaces around it, quotes, and a comment behind it.
inline std::string_view plain_value(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  if (const auto comment = text.find(" #"); comment != std::string_view::npos) text = text.substr(0, comment);
  const auto begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  text = text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
  const bool is_quoted =
      text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

inline void add_value(yaml_parser_t& parser, std::string_view value, yaml_mark_t mark) {
  if (value.size() < 2 || value.front() != '[' || value.back() != ']') {
    return add_event(parser, YAML_SCALAR_EVENT, mark, value);
  }
  add_event(parser, YAML_SEQUENCE_START_EVENT, mark);
  value = value.substr(1, value.size() - 2);
  for (std::size_t at = 0; at <= value.size();) {
    const auto end = std::min(value.find(',', at), value.size());
    add_event(parser, YAML_SCALAR_EVENT, mark, plain_value(value.substr(at, end - at)));
    at = end + 1;
  }
  add_event(parser, YAML_SEQUENCE_END_EVENT, mark);
}

}  // namespace kith::detail

inline void yaml_parser_set_input_string(yaml_parser_t* parser, const unsigned char* input, std::size_t size) {
  using namespace kith::detail;
  const std::string_view text{reinterpret_cast<const char*>(input), size};
  add_event(*parser, YAML_STREAM_START_EVENT, {});
  add_event(*parser, YAML_MAPPING_START_EVENT, {});
  yaml_mark_t mark;
  for (std::size_t at = 0; at < text.size(); ++mark.line) {
    const auto end = std::min(text.find('\n', at), text.size());
    const auto line = text.substr(at, end - at);
    at = end + 1;
    if (plain_value(line).empty() || line.front() == '#' || plain_value(line) == "---") continue;
    const auto colon = line.find(':');
    if (colon == std::string_view::npos || line.front() == ' ') {
      parser->problem = "write a key and a value per line";
      parser->problem_mark = mark;
      return;
    }
    add_event(*parser, YAML_SCALAR_EVENT, mark, plain_value(line.substr(0, colon)));
    add_value(*parser, plain_value(line.substr(colon + 1)), {mark.line, colon + 1});
  }
  add_event(*parser, YAML_MAPPING_END_EVENT, mark);
  add_event(*parser, YAML_STREAM_END_EVENT, mark);
}

// 0: the text goes on otherwise than such a table.
inline int yaml_parser_parse(yaml_parser_t* parser, yaml_event_t* event) {
  if (parser->next == parser->events.size()) return 0;
  *event = parser->events[parser->next++];
  event->data.scalar = {reinterpret_cast<unsigned char*>(event->text.data()), event->text.size()};
  return 1;
}
