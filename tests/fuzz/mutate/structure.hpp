#pragma once

// What a text is made of, as far as mutations have to know it: where its values, names and lists of items stand. It is
// found for any text, well-formed or not.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kith::fuzzing {

/// Bytes [begin, end) of a text.
struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
  [[nodiscard]] bool meets(const Range& other) const noexcept { return begin < other.end && other.begin < end; }
};

enum class ValueKind { kInteger, kReal, kText, kBoolean, kOther, kCompound };

struct ValueRange {
  Range range;
  ValueKind kind = ValueKind::kOther;
};

/// Lists of one level hold items of one kind, which can go from one to another.
enum class Level { kSections, kLines, kElements, kMembers };

/// Items that can be left out, repeated and exchanged.
struct ItemList {
  Level level = Level::kLines;
  std::string separator{};  ///< Between items; empty where it belongs to them.
  std::vector<Range> items{};
  bool named = false;  ///< Each begins with its name, and no two may have the same.
};

struct Structure {
  std::vector<ItemList> lists;
  std::vector<ValueRange> values;
  std::vector<Range> names;
};

/// The kind of a value that is no array, table or quoted text, by its look.
[[nodiscard]] ValueKind kind_of_word(std::string_view word);

/// Adds the value at `begin` (a string, array, table or bare word) with all that is in it. `assign` stands between the
/// names and values of a table: '=' in TOML, ':' in JSON. Returns where the value ends.
std::size_t scan_value(std::string_view text, std::size_t begin, char assign, Structure& structure,
                       std::size_t depth = 0);

/// A TOML document: sections, each a header with the lines below it; statements; values.
[[nodiscard]] Structure structure_of_toml(std::string_view text);
[[nodiscard]] Structure structure_of_json(std::string_view text);
/// Rows and their cells; the cells of the first row are names.
[[nodiscard]] Structure structure_of_csv(std::string_view text);
/// Lines of words separated by blanks; the parts of words are values.
[[nodiscard]] Structure structure_of_lines(std::string_view text);

}  // namespace kith::fuzzing
