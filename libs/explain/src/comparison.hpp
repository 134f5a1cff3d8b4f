#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "lexicon.hpp"
#include "question_tokens.hpp"

namespace kith::detail {

// Whether words compare what two things are worth: "is rubble worse than two steps", "would it rather ... or ...".
[[nodiscard]] bool compares(const Lexicon& lexicon, const std::vector<Token>& tokens);

// What they ask, as a half-space: "would it rather take 2 steps than cross rubble" is (-1, 0, 2). Nothing if one of the
// sides is an action, which has no weight.
// @throws kith::Error (E1103, E1106) if a word is not known, or a side is missing.
[[nodiscard]] std::optional<HalfSpace> read_comparison(const Domain& domain, const Lexicon& lexicon,
                                                       const std::string& text, const std::vector<Token>& tokens);

// A sentence about the robot's reward as kith prints it.
struct ReadSentence {
  HalfSpace said;
  std::optional<HalfSpace> condition;
};
// Reads every sentence that in_words() makes, in any case and with or without a full stop; nothing if it is none.
[[nodiscard]] std::optional<ReadSentence> read_sentence(const Domain& domain, const std::string& text);

}  // namespace kith::detail
