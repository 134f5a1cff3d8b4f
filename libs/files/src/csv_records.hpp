#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kith::detail {

// A record of a CSV text.
struct CsvRecord {
  std::size_t line = 0;                            // where it begins, from 1
  std::string_view text;                           // all of its lines
  std::vector<std::optional<std::string>> fields;  // nothing for an empty field without quotes
  bool malformed = false;                          // quotes that do not match; no fields then
  char separator = ',';                            // between fields
};

// Where a field begins in the text of its record: lines below the first,
// the text of that line, the byte in it, and the field's characters.
struct CsvPlace {
  std::size_t line = 0;
  std::string_view line_text;
  std::size_t offset = 0;
  std::size_t length = 1;
};
[[nodiscard]] CsvPlace locate(std::string_view record, std::size_t field, char separator);

// What separates the fields of a text: a comma if its first line that is not blank has one outside quotes, else a
// semicolon, else a tab. Spreadsheets write semicolons or tabs where numbers have decimal commas.
[[nodiscard]] char separator_of(std::string_view text);

// Calls back with every record that is not a blank line; stops when told false. A first line such as "sep=;" says what
// separates fields and is no record.
void for_each_record(std::string_view text, const std::function<bool(const CsvRecord&)>& on_record);

}  // namespace kith::detail
