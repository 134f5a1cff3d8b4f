#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lexicon.hpp"
#include "question_parser.hpp"
#include "question_words.hpp"

namespace kith::detail {

// Reads a question word by word. What is polite, and what says where the robot is, may stand between any two words that
// the grammar takes; whatever the grammar leaves is refused.
class Reader {
 public:
  static constexpr const char* kForms =
      "ask for instance 'when up', 'where up', 'why up not left at (2,1)', 'what at (2,1)', 'what if no wall' or "
      "'how much step'";

  Reader(const Domain& domain, const std::string& text);

  // Whether the next word that counts has one of these meanings; takes it if it has.
  [[nodiscard]] bool sees(Meanings meanings) const { return find(meanings) != kNowhere; }
  bool takes(Meanings meanings) { return take(meanings).has_value(); }
  std::optional<Token> take(Meanings meanings);
  // The next word that counts if it is one of the domain; not beyond one of these meanings.
  std::optional<Token> take_name(Meanings stops = 0);
  std::optional<Token> take_number();
  // The next word as it stands, whatever it means.
  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  [[nodiscard]] const std::vector<Token>& tokens() const { return tokens_; }
  // The first token from here on that is not passed over, or the end.
  [[nodiscard]] std::size_t next() const;
  [[nodiscard]] bool is_done() const { return next() == end_; }
  void stop_before(std::size_t end) { end_ = end; }
  void read_to_the_end() { end_ = tokens_.size(); }
  // The cell that stands next and is that of a thing.
  std::optional<Cell> take_cell();
  // Puts place, world and what is carried into the question. @throws kith::Error if anything is left or said twice.
  void finish(Question& question) const;

  [[noreturn]] void fail_at(const Place& place, const std::string& id, const std::string& message,
                            const Advice& advice) const {
    fail(text_, place, id, message, advice);
  }
  // Says which word cannot stand here.
  void refuse_what_is_left() const;
  [[nodiscard]] Place whole() const { return {1, std::max<std::size_t>(text_.size(), 1)}; }
  [[nodiscard]] const Domain& domain() const { return domain_; }
  [[nodiscard]] const Lexicon& lexicon() const { return lexicon_; }

 private:
  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  [[nodiscard]] std::size_t find(Meanings meanings) const;
  [[nodiscard]] static bool passes_over(const Token& token);
  [[noreturn]] void refuse(const Token& token) const;
  [[noreturn]] void fail_unknown(const Token& token) const;

  [[nodiscard]] std::vector<Token> with_worlds(std::vector<Token> tokens) const;
  // Contexts, from token i on: how many tokens say one, which is put in place of the first.
  std::size_t read_context(std::vector<Token>& tokens, std::size_t i) const;
  std::size_t read_world(std::vector<Token>& tokens, std::size_t i) const;
  std::size_t read_state(std::vector<Token>& tokens, std::size_t i) const;
  std::size_t read_item(std::vector<Token>& tokens, std::size_t i) const;
  [[nodiscard]] bool is_way_of_speaking(const std::vector<Token>& tokens, std::size_t i) const;
  void name_state(Token& token) const;
  void place_cell(Token& token) const;

  const Domain& domain_;
  std::optional<GridMap> map_;
  const std::string& text_;
  Lexicon lexicon_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0, end_ = 0;
};

// A statement about the robot's reward as a half-space: "would it rather take 2 steps than cross rubble" is (-1, 0, 2).
// Reads what people compare and every sentence that in_words() makes.
[[nodiscard]] HalfSpace read_claim(Reader& reader);
// Whether what is left to read compares.
[[nodiscard]] bool sees_claim(const Reader& reader);

}  // namespace kith::detail
