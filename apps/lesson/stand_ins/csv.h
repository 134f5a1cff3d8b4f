#pragma once

// In place of libcsv, which Debian has compiled for another machine: as much of it as libs/files uses, in strict mode.

#include <cstddef>
#include <string>

inline constexpr unsigned char CSV_STRICT = 1, CSV_STRICT_FINI = 4, CSV_EMPTY_IS_NULL = 16;
inline constexpr int CSV_ENOMEM = 2;

struct csv_parser {
  enum class State { kRecord, kField, kPlain, kQuoted, kQuote };
  State state = State::kRecord;  // kRecord: nothing of the record was read; kQuote: behind a quote in a quoted field
  char separator = ',';
  std::string field;
};

using csv_on_field = void (*)(void* text, std::size_t size, void* data);
using csv_on_end = void (*)(int last, void* data);

inline int csv_init(csv_parser* parser, unsigned char) {
  *parser = {};
  return 0;
}
inline void csv_free(csv_parser*) {}
inline int csv_error(const csv_parser*) { return 0; }
inline void csv_set_space_func(csv_parser*, int (*)(unsigned char)) {}
inline void csv_set_delim(csv_parser* parser, unsigned char separator) {
  parser->separator = static_cast<char>(separator);
}

namespace kith::detail {
inline void end_field(csv_parser& parser, csv_on_field on_field, void* data) {
  const bool is_null = parser.field.empty() && parser.state != csv_parser::State::kQuote;
  on_field(is_null ? nullptr : parser.field.data(), parser.field.size(), data);
  parser.field.clear();
}
}  // namespace kith::detail

// The number of bytes read: fewer than there are if the text is malformed.
inline std::size_t csv_parse(csv_parser* parser, const void* text, std::size_t size, csv_on_field on_field,
                             csv_on_end on_end, void* data) {
  using State = csv_parser::State;
  auto& state = parser->state;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<const char*>(text)[i];
    const bool ends_line = c == '\n' || c == '\r';
    if (state == State::kQuoted) {
      if (c == '"') {
        state = State::kQuote;
      } else {
        parser->field += c;
      }
    } else if (c == '"' && state == State::kQuote) {
      parser->field += c;
      state = State::kQuoted;
    } else if (c == '"') {
      if (state == State::kPlain) return i;
      state = State::kQuoted;
    } else if (c == parser->separator) {
      kith::detail::end_field(*parser, on_field, data);
      state = State::kField;
    } else if (ends_line) {
      if (state == State::kRecord) continue;
      kith::detail::end_field(*parser, on_field, data);
      on_end(c, data);
      state = State::kRecord;
    } else {
      if (state == State::kQuote) return i;
      parser->field += c;
      state = State::kPlain;
    }
  }
  return size;
}

inline int csv_fini(csv_parser* parser, csv_on_field on_field, csv_on_end on_end, void* data) {
  using State = csv_parser::State;
  if (parser->state == State::kQuoted) return -1;
  if (parser->state != State::kRecord) {
    kith::detail::end_field(*parser, on_field, data);
    on_end(-1, data);
  }
  parser->state = State::kRecord;
  return 0;
}
