#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "question_parser.hpp"

namespace kith::detail {

// What a word or phrase can mean in a question.
enum class Meaning : std::uint8_t {
#define KITH_WORDS(meaning, phrases) meaning,
#include "question_words.def"
};

// A set of meanings.
using Meanings = std::uint64_t;
template <typename... Some>
[[nodiscard]] constexpr Meanings one_of(Some... some) {
  return ((Meanings{1} << static_cast<unsigned>(some)) | ...);
}

[[nodiscard]] constexpr bool means(Meanings meanings, Meaning meaning) { return (meanings & one_of(meaning)) != 0; }

// Of a word or a phrase, its words with single spaces between.
[[nodiscard]] Meanings meanings_of(const std::string& phrase);
constexpr std::size_t kLongestPhrase = 7;  // in words
// All words and phrases of a meaning.
[[nodiscard]] std::vector<std::string> words_that_mean(Meaning meaning);
// Rows of words that people use for each other.
[[nodiscard]] const std::vector<std::vector<std::string>>& synonyms();
// The part of a word that its forms share: "recharg" of "recharges" and "recharging".
[[nodiscard]] std::string stem(std::string word);
// Whether a word of this stem says no more than that the robot has to do with something: "enter", "visit".
[[nodiscard]] bool is_contact(const std::string& stem_of_word);

struct Token {
  // kName: a word of the domain.
  enum class Kind { kWord, kName, kNumber, kFraction, kCell, kQuoted, kWorld, kState, kItem, kComma, kSign };
  Kind kind = Kind::kWord;
  std::string text;                 // lower case, except for names
  std::size_t number = 0, row = 0;  // of a world or an item its number, of a fraction number / row
  Place place;
  Meanings meanings = 0;  // of a word or phrase
};

// Words ("doesn't" as two of them), numbers ("2", "1,000"), fractions ("1.5", "1/2"), cells, names in quotes, commas,
// and signs: all that is none of these and does not only separate them, such as the "-2" of "(-2,3)".
[[nodiscard]] std::vector<Token> tokens_of(const std::string& text);
// The same with phrases as one token each, and what they mean.
[[nodiscard]] std::vector<Token> with_phrases(const std::vector<Token>& tokens);
// What some of them say, and where.
[[nodiscard]] std::vector<std::string> texts_of(const std::vector<Token>& tokens);
[[nodiscard]] std::string phrase(const std::vector<Token>& tokens);
[[nodiscard]] Place place_of(const std::vector<Token>& tokens);

}  // namespace kith::detail
