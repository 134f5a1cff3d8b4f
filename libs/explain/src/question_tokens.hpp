#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "question_parser.hpp"

namespace kith::detail {

struct Token {
  enum class Kind { kWord, kNumber, kCell, kName };
  Kind kind = Kind::kWord;
  std::string text;  // lower case, except for names
  std::size_t number = 0, row = 0;
  Place place;
};

// Words, numbers, cells and names in quotes; whatever else is there separates them.
[[nodiscard]] std::vector<Token> tokens_of(const std::string& text);

}  // namespace kith::detail
