#pragma once

// Mutations that leave most of an input as it is. The result follows from the input and the dice alone.

#include <string>
#include <string_view>

#include "dice.hpp"
#include "vocabulary.hpp"

namespace kith::fuzzing {

/// TOML, JSON, CSV or lines of words: a word (name, number, what is between quotes) for another of its kind, of the
/// text or of the vocabulary; or lines left out, repeated, exchanged.
[[nodiscard]] std::string mutate_text(std::string_view text, const Vocabulary& vocabulary, Dice& dice);
/// The text with a word or some lines of another.
[[nodiscard]] std::string cross_text(std::string_view text, std::string_view other, Dice& dice);
/// Any bytes: some set, flipped, moved, repeated or left out.
[[nodiscard]] std::string mutate_bytes(std::string_view bytes, Dice& dice);
/// Rows of `width` numbers, if that is not 0, behind a head of `head` bytes: rows and numbers changed, exchanged,
/// repeated, left out.
[[nodiscard]] std::string mutate_vectors(std::string_view bytes, std::size_t head, std::size_t width, Dice& dice);

}  // namespace kith::fuzzing
