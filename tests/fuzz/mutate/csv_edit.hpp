#pragma once

#include <optional>

#include "dice.hpp"
#include "structure.hpp"
#include "vocabulary.hpp"

namespace kith::fuzzing {

/// A record of a CSV table with its line end.
struct CsvLine {
  Range range;
  std::vector<Range> cells{};  ///< As written, with their quotes.
};
[[nodiscard]] std::vector<CsvLine> lines_of_csv(std::string_view text);

/// A text as a cell, between quotes where it needs them.
[[nodiscard]] std::string quoted_cell(std::string_view text);

/// Columns exchanged, left out, repeated or added, or one filled with values of another.
[[nodiscard]] std::string edit_columns(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
/// A cell that holds JSON with one change inside; nothing if there is no such cell.
[[nodiscard]] std::optional<std::string> edit_json_cell(std::string_view text, const Vocabulary& vocabulary,
                                                        Dice& dice);

}  // namespace kith::fuzzing
