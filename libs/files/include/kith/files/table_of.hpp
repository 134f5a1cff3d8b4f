#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kith/files/codebook.hpp"
#include "kith/files/csv_writer.hpp"

namespace kith {

/// What people read about a column; its type follows from its values.
struct ColumnWords {
  std::string_view name;
  std::string_view description;  ///< One sentence.
  std::string_view unit = "";    ///< Such as "sr"; empty if there is none.
  ColumnKind kind = ColumnKind::kUnspecified;
};

namespace columns {

/// Names a team, a person or the like.
[[nodiscard]] constexpr ColumnWords identifier(std::string_view name, std::string_view description) {
  return {name, description, "", ColumnKind::kIdentifier};
}
/// Counts events.
[[nodiscard]] constexpr ColumnWords count(std::string_view name, std::string_view description) {
  return {name, description, "", ColumnKind::kCount};
}
/// A measurement, whatever its values look like.
[[nodiscard]] constexpr ColumnWords measure(std::string_view name, std::string_view description,
                                            std::string_view unit = "") {
  return {name, description, unit, ColumnKind::kNumber};
}

}  // namespace columns

namespace detail {

template <typename Value>
struct CellType {
  static constexpr bool kIsOptional = false;
  using Type = Value;
};
template <typename Value>
struct CellType<std::optional<Value>> {
  static constexpr bool kIsOptional = true;
  using Type = Value;
};

template <typename Value>
[[nodiscard]] constexpr ColumnType column_type() {
  if constexpr (std::same_as<Value, bool>) {
    return ColumnType::kBoolean;
  } else if constexpr (std::integral<Value>) {
    return ColumnType::kInteger;
  } else if constexpr (std::floating_point<Value>) {
    return ColumnType::kReal;
  } else {
    static_assert(std::convertible_to<const Value&, std::string_view>);
    return ColumnType::kText;
  }
}

template <typename Value>
void write_cell(CsvWriter& writer, const Value& value) {
  constexpr auto kType = column_type<Value>();
  if constexpr (kType == ColumnType::kBoolean) {
    writer.boolean(value);
  } else if constexpr (kType == ColumnType::kInteger) {
    writer.integer(value);
  } else if constexpr (kType == ColumnType::kReal) {
    writer.real(value);
  } else {
    writer.text(std::string_view{value});
  }
}
template <typename Value>
void write_cell(CsvWriter& writer, const std::optional<Value>& value) {
  if (value) {
    write_cell(writer, *value);
  } else {
    writer.missing();
  }
}

}  // namespace detail

/// What is seldom said of a column.
struct ColumnOptions {
  std::optional<bool> required{};  ///< Whether every row has a value; else whether the values are not optional.
  std::string_view before{};       ///< The column that it stands in front of, if the table has that; else it is last.
};

/// A table whose rows are made from values of one type. A column is one line, which gives the codebook its entry and
/// every row its cell:
///
///   TableOf<Answer> answers{"answers.csv", "One answer."};
///   answers.column(&Answer::seconds, {"rt", "Time from the test appearing to submitting.", "s"});
///
/// Integers, reals, booleans and texts are cells; an optional one is missing where it is empty.
template <typename Row>
class TableOf {
 public:
  TableOf(std::string file, std::string description)
      : table_{.file = std::move(file), .description = std::move(description)} {}

  /// Adds a column. @param value  a member of Row, or a function of a row.
  template <typename Value>
  requires std::invocable<const Value&, const Row&> TableOf& column(Value value, const ColumnWords& words,
                                                                    const ColumnOptions& options = {}) {
    using Held = detail::CellType<std::remove_cvref_t<std::invoke_result_t<const Value&, const Row&>>>;
    const auto place = place_before(options.before);
    table_.columns.insert(table_.columns.begin() + place, {.name = std::string{words.name},
                                                           .type = detail::column_type<typename Held::Type>(),
                                                           .description = std::string{words.description},
                                                           .unit = std::string{words.unit},
                                                           .required = options.required.value_or(!Held::kIsOptional),
                                                           .kind = words.kind});
    cells_.insert(cells_.begin() + place, [value = std::move(value)](CsvWriter& writer, const Row& row) {
      detail::write_cell(writer, std::invoke(value, row));
    });
    return *this;
  }

  [[nodiscard]] const TableDescription& description() const noexcept { return table_; }

  /// Writes one row. @pre the writer's columns are those of description().
  void write(CsvWriter& writer, const Row& row) const {
    for (const auto& cell : cells_) cell(writer, row);
    writer.end_row();
  }

 private:
  [[nodiscard]] std::ptrdiff_t place_before(std::string_view name) const {
    const auto& all = table_.columns;
    return std::find_if(all.begin(), all.end(), [&](const Column& one) { return one.name == name; }) - all.begin();
  }

  TableDescription table_;
  std::vector<std::function<void(CsvWriter&, const Row&)>> cells_;  // as the columns
};

}  // namespace kith
