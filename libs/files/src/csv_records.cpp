#include "csv_records.hpp"

#include <algorithm>
#include <new>

namespace kith::detail {
namespace {

int never_space(unsigned char) { return 0; }

// libcsv fed line by line, so that the places of records are known.
class Splitter {
 public:
  explicit Splitter(char separator) : separator_{separator} { open(); }
  ~Splitter() { csv_free(&parser_); }
  Splitter(const Splitter&) = delete;
  Splitter& operator=(const Splitter&) = delete;

  // Whether the line ends a record (or is malformed).
  bool feed(std::string_view line, CsvRecord& record) {
    ended_ = false;
    record_ = &record;
    if (csv_parse(&parser_, line.data(), line.size(), on_field, on_end, this) != line.size()) give_up(record);
    return ended_;
  }

  // Ends a record that has no line end.
  bool finish(CsvRecord& record) {
    ended_ = false;
    record_ = &record;
    if (csv_fini(&parser_, on_field, on_end, this) != 0) give_up(record);
    return ended_;
  }

 private:
  void open() {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI | CSV_EMPTY_IS_NULL) != 0) throw std::bad_alloc{};
    csv_set_space_func(&parser_, never_space);  // blanks belong to the fields
    csv_set_delim(&parser_, static_cast<unsigned char>(separator_));
  }

  // Forgets the rest of the record; the next line begins a new one.
  void give_up(CsvRecord& record) {
    const bool out_of_memory = csv_error(&parser_) == CSV_ENOMEM;
    csv_free(&parser_);
    open();
    if (out_of_memory) throw std::bad_alloc{};
    record.malformed = true;
    record.fields.clear();
    ended_ = true;
  }

  static void on_field(void* data, std::size_t size, void* self) {
    auto& fields = static_cast<Splitter*>(self)->record_->fields;
    if (data == nullptr) {
      fields.emplace_back();
    } else {
      fields.emplace_back(std::string(static_cast<const char*>(data), size));
    }
  }
  static void on_end(int, void* self) { static_cast<Splitter*>(self)->ended_ = true; }

  char separator_;
  csv_parser parser_{};
  CsvRecord* record_ = nullptr;
  bool ended_ = false;
};

// "sep=;" in a line of its own, which spreadsheets write and read.
bool says_separator(std::string_view text) {
  return text.starts_with("sep=") && (text.substr(5, 1) == "\n" || text.substr(5, 2) == "\r\n");
}

bool is_blank(std::string_view line) { return line.find_first_not_of("\r\n") == std::string_view::npos; }

}  // namespace

char separator_of(std::string_view text) {
  const auto begin = std::min(text.find_first_not_of("\r\n"), text.size());
  bool quoted = false;
  char found = 0;
  for (const char c : text.substr(begin)) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ',') return ',';
    if (c == '\n' || c == '\r') break;
    if (c == ';' || (c == '\t' && found == 0)) found = c;
  }
  return found == 0 ? ',' : found;
}

void for_each_record(std::string_view text, const std::function<bool(const CsvRecord&)>& on_record) {
  CsvRecord record;
  const bool is_said = says_separator(text);
  record.separator = is_said ? text[4] : separator_of(text);
  Splitter splitter{record.separator};
  std::size_t record_begin = 0;
  std::size_t line_number = is_said ? 1 : 0;
  bool is_open = false;
  for (std::size_t begin = is_said ? text.find('\n') + 1 : 0; begin < text.size();) {
    const std::size_t newline = text.find('\n', begin);
    const std::size_t end = newline == std::string_view::npos ? text.size() : newline + 1;
    const std::string_view line = text.substr(begin, end - begin);
    ++line_number;
    if (!is_open) {
      record_begin = begin;
      record.line = line_number;
      record.fields.clear();
      record.malformed = false;
    }
    begin = end;
    if (!is_open && is_blank(line)) continue;
    bool ended = splitter.feed(line, record);
    if (!ended && end == text.size()) ended = splitter.finish(record);
    is_open = !ended;
    record.text = text.substr(record_begin, end - record_begin);
    if (ended && !on_record(record)) return;
  }
}

CsvPlace locate(std::string_view record, std::size_t field, char separator) {
  // The byte at which the field begins and the one at which it ends.
  std::size_t at = 0;
  std::size_t current = 0;
  std::size_t begin = 0;
  bool quoted = false;
  for (; at < record.size(); ++at) {
    const char c = record[at];
    if (c == '"') quoted = !quoted;
    if (quoted || (c != separator && c != '\n' && c != '\r')) continue;
    if (current == field || c != separator) break;
    ++current;
    begin = at + 1;
  }
  CsvPlace place;
  const std::string_view before = record.substr(0, begin);
  place.line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  const std::size_t last = before.rfind('\n');
  const std::size_t line_begin = last == std::string_view::npos ? 0 : last + 1;
  const std::size_t line_end = std::min(record.find_first_of("\r\n", line_begin), record.size());
  place.line_text = record.substr(line_begin, line_end - line_begin);
  place.offset = begin - line_begin;
  place.length = std::max<std::size_t>(1, std::min(at, line_end) - std::min(begin, line_end));
  return place;
}

}  // namespace kith::detail
