#pragma once

#include <string>
#include <string_view>

namespace kith {

/// What the cells of a column are.
enum class ColumnType {
  kText,     ///< UTF-8.
  kInteger,  ///< 64 bits, with sign.
  kReal,     ///< Double precision; inf and -inf are values, NaN is not.
  kBoolean,  ///< true or false.
};

/// "text", "integer", "real" or "boolean".
[[nodiscard]] std::string_view to_string(ColumnType type) noexcept;

/// What the values of a column stand for, where that decides how they are analysed.
enum class ColumnKind {
  kUnspecified,
  kIdentifier,  ///< Names a team, a person or the like: rows with the same value belong together.
  kCount,       ///< Counts of events: whole numbers >= 0.
  kOrdinal,     ///< Ordered categories, such as answers on a Likert scale.
  kNumber,      ///< Measurements, whatever they look like.
};

/// "identifier", "count", "ordinal" or "number"; empty if unspecified.
[[nodiscard]] std::string_view to_string(ColumnKind kind) noexcept;

/// One column of a table, as its codebook describes it.
struct Column {
  std::string name = {};  ///< Unique in the table, not empty.
  ColumnType type = ColumnType::kText;
  std::string description = {};  ///< One sentence for people who analyse the table.
  std::string unit = {};         ///< Such as "sr"; empty if there is none.
  bool required = false;         ///< Whether every row has a value.
  ColumnKind kind = ColumnKind::kUnspecified;
  friend bool operator==(const Column&, const Column&) = default;
};

}  // namespace kith
