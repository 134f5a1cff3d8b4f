#pragma once

// Changes of a text whose structure is known.

#include <optional>
#include <vector>

#include "dice.hpp"
#include "structure.hpp"
#include "vocabulary.hpp"

namespace kith::fuzzing {

/// How values of a format are written.
struct Format {
  Structure (*structure)(std::string_view text) = nullptr;
  std::string (*quoted)(std::string_view text) = nullptr;  ///< A text as a value.
  std::vector<std::string_view> integers{};
  std::vector<std::string_view> reals{};
  std::vector<std::string_view> others{};                               ///< Dates, nothing at all, ...
  std::vector<std::pair<std::string_view, std::string_view>> around{};  ///< What a value can be put between.
};

/// New text in place of a range.
struct Replacement {
  Range range;
  std::string text;
};
/// @pre no two of the ranges meet
[[nodiscard]] std::string replaced(std::string_view text, std::vector<Replacement> replacements);

/// One change of a list, a value or a name.
[[nodiscard]] std::string edit(std::string_view text, const Format& format, const Vocabulary& vocabulary, Dice& dice);
/// One part replaced by, or one item added from, the other text.
[[nodiscard]] std::string splice(std::string_view text, std::string_view other, const Format& format, Dice& dice);

/// The parts of edit(); nothing where there is nothing to change.
[[nodiscard]] std::optional<std::string> edit_list(std::string_view text, const Structure& structure, Dice& dice);
[[nodiscard]] std::optional<std::string> edit_value(std::string_view text, const Structure& structure,
                                                    const Format& format, const Vocabulary& vocabulary, Dice& dice);
[[nodiscard]] std::optional<std::string> edit_name(std::string_view text, const Structure& structure,
                                                   const Vocabulary& vocabulary, Dice& dice);

/// The numbers of `format` and others near `word`; the words of the vocabulary; a value of that kind.
[[nodiscard]] std::string value_of_kind(ValueKind kind, std::string_view word, const Format& format,
                                        const Vocabulary& vocabulary, Dice& dice);

}  // namespace kith::fuzzing
