#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "question_parser.hpp"
#include "question_tokens.hpp"

namespace kith::detail {

// The words of questions, whatever the domain: how a question begins, what it compares by, and what adds nothing.

// Words that may stand anywhere in a question and add nothing to it: "please", "robot", "ever".
[[nodiscard]] bool is_filler(const std::string& word);
// Verbs that say no more than that the robot has to do with something: "enter", "pass", "visit".
[[nodiscard]] bool is_contact(const std::string& stem_of_word);
// Words that deny what follows: "not", "doesn't", "avoid", "past".
[[nodiscard]] bool denies(const std::string& word);
// "does", "will", "is", ...: with one of them a question may begin.
[[nodiscard]] bool is_auxiliary(const std::string& word);
// Words that speak of what something is worth: "minds", "worse", "likes", "matters".
[[nodiscard]] bool speaks_of_value(const std::string& word);

// Words that begin a question of some kind.
struct Opening {
  Question::Kind kind = Question::Kind::kWhen;
  std::size_t begin = 0;  // tokens
  std::size_t end = 0;
  bool removes = false;  // "without", "what difference does ... make"
};
// The first one; of those that begin at the same word the longest.
[[nodiscard]] std::optional<Opening> find_opening(const std::vector<Token>& tokens);

}  // namespace kith::detail
