#pragma once

// Mutations that keep a text in its format, mostly: what they exchange, leave out and repeat are keys, values, tables,
// rows and columns. The result follows from the text and the dice alone.

#include <string>
#include <string_view>

#include "dice.hpp"
#include "vocabulary.hpp"

namespace kith::fuzzing {

[[nodiscard]] std::string mutate_toml(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
[[nodiscard]] std::string mutate_json(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
/// Cells that hold JSON are mutated as such, now and then.
[[nodiscard]] std::string mutate_csv(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
/// Lines of words.
[[nodiscard]] std::string mutate_lines(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
/// Any bytes: some set, flipped, moved, repeated or left out.
[[nodiscard]] std::string mutate_bytes(std::string_view bytes, Dice& dice);
/// Rows of `width` numbers behind a head of `head` bytes: rows and numbers changed, exchanged, repeated, left out.
[[nodiscard]] std::string mutate_vectors(std::string_view bytes, std::size_t head, std::size_t width, Dice& dice);

/// The text with a part (a table, a line, an element, a value) of another of the same format.
[[nodiscard]] std::string cross_toml(std::string_view text, std::string_view other, Dice& dice);
[[nodiscard]] std::string cross_json(std::string_view text, std::string_view other, Dice& dice);
[[nodiscard]] std::string cross_csv(std::string_view text, std::string_view other, Dice& dice);
[[nodiscard]] std::string cross_lines(std::string_view text, std::string_view other, Dice& dice);

}  // namespace kith::fuzzing
