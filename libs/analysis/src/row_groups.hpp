#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/analysis/dataset.hpp"

namespace kith {

// Which rows of a table belong together, because an identifier repeats.
struct RowGroups {
  // The groups of every random intercept, as the columns whose combinations of values they are: {"team"}, {"team",
  // "member"}. Empty if the rows are independent as far as the columns tell.
  std::vector<std::vector<std::string>> intercepts;
  std::vector<std::string> notes;  // what should be said about columns that look like identifiers but are not used
  std::vector<std::string> items;  // columns of repeated tasks or questions, whose rows may be alike as well
};

// Whether one of these, in small letters, is a word of a column's name: "trust_likert" and "trustLikert" have the word
// likert, "operating_minutes" has not the word rating.
[[nodiscard]] bool has_word(const std::string& column, std::span<const std::string_view> wanted);

// Whether a column of this name holds identifiers: "team", "participant_id", "personId".
[[nodiscard]] bool is_identifier_name(const std::string& column);

// The groups that the identifiers of a table make of its rows: columns said to be identifiers, or named like one.
// Columns in `used`, the response and the factors of the model, are no groups.
[[nodiscard]] RowGroups find_row_groups(const Dataset& rows, const std::vector<std::string>& used);

// "(1|team) + (1|team:member)"
[[nodiscard]] std::string intercepts_text(const std::vector<std::vector<std::string>>& intercepts);

// Which group each row is in. A row without a value in one of the columns is a group of its own unless an earlier
// column has one.
[[nodiscard]] Factor row_factor(const Dataset& rows, const std::vector<std::string>& columns);

}  // namespace kith
