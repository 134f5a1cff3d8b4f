#include "csv_records.hpp"

#include <algorithm>
#include <utility>

namespace kith::detail {
namespace {

// Takes a text line by line, so that the places of records are known. Quotes stand at both ends of a field or are
// doubled inside of it, as RFC 4180 has it; blanks belong to fields.
class Splitter {
 public:
  explicit Splitter(char separator) : separator_{separator} {}

  // Whether the line ends a record (or is malformed).
  bool feed(std::string_view line, CsvRecord& record) {
    bool ended = false;
    for (const char c : line) {
      if (c == '"') {
        if (state_ == State::kPlain) return give_up(record);
        if (state_ == State::kQuote) field_ += c;
        state_ = state_ == State::kQuoted ? State::kQuote : State::kQuoted;
      } else if (state_ == State::kQuoted) {
        field_ += c;
      } else if (c == separator_) {
        end_field(record, State::kField);
      } else if (c == '\n' || c == '\r') {
        if (state_ == State::kRecord) continue;
        end_field(record, State::kRecord);
        ended = true;
      } else if (state_ == State::kQuote) {
        return give_up(record);
      } else {
        field_ += c;
        state_ = State::kPlain;
      }
    }
    return ended;
  }

  // Ends a record that has no line end.
  bool finish(CsvRecord& record) {
    if (state_ == State::kQuoted) return give_up(record);
    if (state_ == State::kRecord) return false;
    end_field(record, State::kRecord);
    return true;
  }

 private:
  // What was read before: nothing of a record, or of a field; part of a field; a quote inside of quotes or at their
  // end.
  enum class State { kRecord, kField, kPlain, kQuoted, kQuote };

  void end_field(CsvRecord& record, State next) {
    const bool is_missing = field_.empty() && state_ != State::kQuote;
    record.fields.push_back(is_missing ? std::nullopt : std::optional{std::exchange(field_, {})});
    state_ = next;
  }
  // Forgets the rest of the record; the next line begins a new one.
  bool give_up(CsvRecord& record) {
    field_.clear();
    state_ = State::kRecord;
    record.malformed = true;
    record.fields.clear();
    return true;
  }

  char separator_;
  State state_ = State::kRecord;
  std::string field_;
};

// "sep=;" in a line of its own, which spreadsheets write and read.
bool says_separator(std::string_view text) {
  if (!text.starts_with("sep=") || text.size() < 6) return false;
  const bool may_separate = std::string_view{"\r\n\""}.find(text[4]) == std::string_view::npos;
  return may_separate && (text[5] == '\n' || text.substr(5, 2) == "\r\n");
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
