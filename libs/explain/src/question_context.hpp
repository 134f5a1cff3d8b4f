#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lexicon.hpp"
#include "question_parser.hpp"
#include "question_tokens.hpp"

namespace kith::detail {

// Reads in which world, where and with what in its hands a question is about the robot: the tokens from at_ on.
class ContextReader {
 protected:
  ContextReader(const Domain& domain, const std::string& text)
      : domain_{domain},
        map_{domain.map()},
        text_{text},
        lexicon_{domain},
        tokens_{with_world_names(domain, tokens_of(text))} {}

  [[noreturn]] void fail_at(const Place& place, const std::string& id, const std::string& message,
                            const Advice& advice = {}) const {
    fail(text_, place, id, message, advice);
  }

  // "state 0", "state on the bank at a1": the longest stretch of words that is a name, or the next word.
  void take_unquoted_state(const Token& word);
  [[nodiscard]] std::set<std::string> state_names() const;
  [[nodiscard]] std::optional<std::string> state_called(const std::string& key) const;
  // The name of a state, in models without a map, or what the model's files call it.
  void take_state(const Token& token);
  // Whether a number stands for a state of a model: "at 36", if there is a state 36.
  [[nodiscard]] bool is_numbered_state(const Token& token) const;
  // The states that the picture of a model shows in a cell, by name.
  [[nodiscard]] std::vector<std::string> drawn_at(std::size_t column, std::size_t row) const;
  static Advice hint_of_states(const std::string& name, const std::vector<std::string>& names);
  void take_cell(const Token& token);
  void take_drawn_cell(const Token& token);
  void take_world(const Token& token);
  void set_world(MdpIndex world, const Place& place);
  // @throws kith::Error (E1106) if a question says something of one kind twice.
  void need_first(bool is_first, const Place& place, const std::string& what) const;
  void take_item(const Token& token);
  // "column 2, row 3", in either order.
  bool take_column_and_row(const Token& first);

  static constexpr const char* kForms =
      "ask for instance 'when up', 'where up', 'why up not left at (2,1)', 'what at (2,1)', 'what if no wall' or "
      "'how much step'";

  const Domain& domain_;
  std::optional<GridMap> map_;
  const std::string& text_;
  Lexicon lexicon_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  Question question_;
};

}  // namespace kith::detail
