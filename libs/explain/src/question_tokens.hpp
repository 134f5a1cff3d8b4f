#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "question_parser.hpp"

namespace kith::detail {

struct Token {
  enum class Kind { kWord, kNumber, kFraction, kCell, kName, kWorld, kSign };
  Kind kind = Kind::kWord;
  std::string text;                 // lower case, except for names
  std::size_t number = 0, row = 0;  // of a world its number, of a fraction number / row
  Place place;
};

// Words, numbers ("2", "1,000"), fractions ("1.5", "1/2"), cells, names in quotes, and signs: all that is none of these
// and does not only separate them, such as the "-2" of "(-2,3)".
[[nodiscard]] std::vector<Token> tokens_of(const std::string& text);

// The same with the names of worlds as one token each: in quotes, behind words such as "in", "during" or "world", or
// anywhere if the name has several words.
[[nodiscard]] std::vector<Token> with_world_names(const Domain& domain, std::vector<Token> tokens);

}  // namespace kith::detail
