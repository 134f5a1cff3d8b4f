#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kith {

/// Where something stands in a TOML text: 1-based line and column (in
/// characters, not bytes). Line 0 means "the text as a whole".
struct TomlPlace {
  std::size_t source = 0;  ///< Index into TomlDocument::sources.
  std::size_t line = 0;
  std::size_t column = 0;
  std::size_t length = 1;  ///< Characters on that line, at least 1.

  friend bool operator==(const TomlPlace&, const TomlPlace&) = default;
};

class TomlValue;
struct TomlEntry;

/// Keys and values in the order of the file. Keys are unique.
class TomlTable {
 public:
  TomlTable();
  TomlTable(const TomlTable&);
  TomlTable(TomlTable&&) noexcept;
  TomlTable& operator=(const TomlTable&);
  TomlTable& operator=(TomlTable&&) noexcept;
  ~TomlTable();

  [[nodiscard]] const std::vector<TomlEntry>& entries() const noexcept { return entries_; }
  [[nodiscard]] bool empty() const noexcept;
  /// The value of `key`, or nullptr.
  [[nodiscard]] const TomlValue* find(std::string_view key) const noexcept;
  [[nodiscard]] TomlValue* find(std::string_view key) noexcept;
  /// The key with its place and value, or nullptr.
  [[nodiscard]] const TomlEntry* find_entry(std::string_view key) const noexcept;
  /// Adds an entry at the end, or replaces the value (and its place) of the key in its old position.
  void set(TomlEntry entry);
  /// Adds an entry at the end. @pre the table has no such key.
  void append(TomlEntry entry);

  /// Same keys with equal values; neither order nor places matter.
  friend bool operator==(const TomlTable& a, const TomlTable& b);

 private:
  std::vector<TomlEntry> entries_;
};

/// A date or time, as written. Nothing in kith takes one; it is kept so that a
/// reader can say what it found instead.
struct TomlDateTime {
  std::string text;
  friend bool operator==(const TomlDateTime&, const TomlDateTime&) = default;
};

using TomlArray = std::vector<TomlValue>;

/// One value of a TOML document, with its place.
class TomlValue {
 public:
  using Content = std::variant<bool, std::int64_t, double, std::string, TomlDateTime, TomlArray, TomlTable>;

  TomlValue() = default;
  explicit TomlValue(Content content, TomlPlace place = {}) : content_{std::move(content)}, place_{place} {}

  [[nodiscard]] const TomlPlace& place() const noexcept { return place_; }
  [[nodiscard]] const Content& content() const noexcept { return content_; }

  /// The content if it is of that type, else nullptr.
  [[nodiscard]] const bool* boolean() const noexcept { return std::get_if<bool>(&content_); }
  [[nodiscard]] const std::int64_t* integer() const noexcept { return std::get_if<std::int64_t>(&content_); }
  [[nodiscard]] const double* real() const noexcept { return std::get_if<double>(&content_); }
  [[nodiscard]] const std::string* string() const noexcept { return std::get_if<std::string>(&content_); }
  [[nodiscard]] const TomlArray* array() const noexcept { return std::get_if<TomlArray>(&content_); }
  [[nodiscard]] const TomlTable* table() const noexcept { return std::get_if<TomlTable>(&content_); }
  [[nodiscard]] TomlTable* table() noexcept { return std::get_if<TomlTable>(&content_); }

  /// Whether it is an integer or a real number.
  [[nodiscard]] bool is_number() const noexcept { return integer() != nullptr || real() != nullptr; }
  /// What people call this kind of value: "a string", "a table", ...
  [[nodiscard]] std::string_view kind_name() const noexcept;

  /// Equal content; places do not matter. NaN equals NaN here: this compares texts, not numbers.
  friend bool operator==(const TomlValue& a, const TomlValue& b);

 private:
  Content content_;
  TomlPlace place_;
};

/// One key of a table.
struct TomlEntry {
  std::string key;
  TomlPlace place;  ///< Of the key.
  TomlValue value;
};

}  // namespace kith
