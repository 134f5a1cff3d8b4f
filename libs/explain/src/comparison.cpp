// "Is rubble worse than two steps?" as an inequality of reward weights.
#include "comparison.hpp"

#include <algorithm>
#include <set>

#include "question_words.hpp"

namespace kith::detail {
namespace {

bool is_word(const Token& token, const char* word) { return token.kind == Token::Kind::kWord && token.text == word; }

// Where one side ends and the other begins: at "than", "or" or "outweighs", or, behind "prefer", at "to" or "over".
std::optional<std::size_t> separator(const Lexicon& lexicon, const std::vector<Token>& tokens) {
  const auto find = [&](const std::set<std::string>& words) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      if (tokens[i].kind == Token::Kind::kWord && words.count(tokens[i].text) != 0) return i;
    }
    return std::nullopt;
  };
  if (const auto than = find({"than", "outweigh", "outweighs"})) return than;
  const auto is_valued =
      std::any_of(tokens.begin(), tokens.end(), [](const Token& token) { return valued(token.text) != Valued::kNo; });
  if (const auto either = find({"or"}); either && is_valued) return either;
  const auto prefer = find({"prefer", "prefers", "preferring"});
  if (!prefer) return std::nullopt;
  bool has_left = false;
  for (std::size_t i = *prefer + 1; i < tokens.size(); ++i) {
    if (has_left && (is_word(tokens[i], "to") || is_word(tokens[i], "over"))) {
      const bool has_right = std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1, tokens.end(),
                                         [&](const Token& token) { return lexicon.names_something(token.text); });
      if (has_right) return i;
    }
    has_left = has_left || lexicon.names_something(tokens[i].text);
  }
  return std::nullopt;
}

// One side: how often each feature, and how its words value it.
class Side {
 public:
  Side(const Domain& domain, const Lexicon& lexicon, const std::string& text, const std::vector<Token>& tokens)
      : domain_{domain}, lexicon_{lexicon}, text_{text}, counts_(domain.num_features()) {
    for (const auto& token : tokens) take(token);
    close();
  }

  [[nodiscard]] const IntegerVector& counts() const { return counts_; }
  [[nodiscard]] bool has_action() const { return has_action_; }
  [[nodiscard]] bool says(const std::string& word) const { return words_.count(word) != 0; }
  [[nodiscard]] bool is_cost() const { return is_cost_; }
  [[nodiscard]] bool is_gain() const { return is_gain_; }
  // 1 if all of it is a gain to the robot, -1 if all of it is a cost, else 0.
  [[nodiscard]] int sign() const {
    int sign = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      if (counts_[k] == 0) continue;
      const int own = domain_.weights().integer[k] < 0 ? -1 : 1;
      if (sign != 0 && sign != own) return 0;
      sign = own;
    }
    return sign;
  }

 private:
  void take(const Token& token) {
    const auto& word = token.text;
    words_.insert(word);
    if (token.kind == Token::Kind::kNumber) {
      n_ = static_cast<std::int64_t>(token.number);
      return;
    }
    if (word == "twice") {
      n_ = 2;
      return;
    }
    if (token.kind != Token::Kind::kWord || word == "times" || word == "less" || word == "fewer") return;
    if (word == "and" || word == "plus") return close();
    const auto value = valued(word);
    is_cost_ = is_cost_ || value == Valued::kCost;
    is_gain_ = is_gain_ || value == Valued::kGain;
    if (denies(word)) {
      fail(text_, token.place, "E1106", "a comparison with '" + word + "' could mean the opposite",
           "compare two things that the robot may do: is ... worse than ..., would it rather ... than ...");
    }
    if (lexicon_.knows(word)) {
      if (phrase_.empty()) place_ = token.place;
      place_.length = token.place.column + token.place.length - place_.column;
      phrase_.push_back(word);
    } else if (const auto n = number_word(word)) {
      n_ = static_cast<std::int64_t>(*n);
    } else if (value == Valued::kNo && !is_filler(word)) {
      fail_unknown(lexicon_, text_, word, token.place, lexicon_.all_words());
    }
  }

  void close() {
    std::erase_if(phrase_, [&](const std::string& word) { return lexicon_.says_only_contact(word); });
    if (phrase_.empty()) return;
    const auto found = lexicon_.happenings(phrase_);
    if (found.size() != 1) {
      std::string said;
      for (const auto& word : phrase_) said += (said.empty() ? "" : " ") + word;
      fail(text_, place_, "E1103", "'" + said + "' is not one of what this robot's reward counts",
           "use the name of a feature");
    }
    if (found.front().action) {
      has_action_ = true;
    } else {
      counts_[found.front().feature] += n_.value_or(1);
    }
    phrase_.clear();
    n_.reset();
  }

  const Domain& domain_;
  const Lexicon& lexicon_;
  const std::string& text_;
  IntegerVector counts_;
  std::set<std::string> words_;
  std::vector<std::string> phrase_;
  Place place_;
  std::optional<std::int64_t> n_;
  bool has_action_ = false, is_cost_ = false, is_gain_ = false;
};

// "cost anything", "is worth something".
bool asks_for_anything(const std::vector<Token>& tokens) {
  const bool any = std::any_of(tokens.begin(), tokens.end(), [](const Token& token) {
    return token.text == "anything" || token.text == "something" || token.text == "nothing";
  });
  return any && std::any_of(tokens.begin(), tokens.end(), [](const Token& token) {
           return token.text == "cost" || token.text == "costs" || token.text == "worth";
         });
}

}  // namespace

bool compares(const Lexicon& lexicon, const std::vector<Token>& tokens) {
  return separator(lexicon, tokens).has_value() || asks_for_anything(tokens);
}

std::optional<HalfSpace> read_comparison(const Domain& domain, const Lexicon& lexicon, const std::string& text,
                                         const std::vector<Token>& tokens) {
  const auto at = separator(lexicon, tokens).value_or(tokens.size());
  const auto middle = tokens.begin() + static_cast<std::ptrdiff_t>(at);
  const Side left{domain, lexicon, text, {tokens.begin(), middle}};
  const Side right{domain, lexicon, text,
                   at == tokens.size() ? std::vector<Token>{} : std::vector<Token>{middle + 1, tokens.end()}};
  if (left.has_action() || right.has_action()) return std::nullopt;
  const Place whole{1, std::max<std::size_t>(text.size(), 1)};
  const bool is_alone = at == tokens.size();
  if (left.counts().is_zero() || (right.counts().is_zero() && !is_alone)) {
    fail(text, whole, "E1106", "what is compared with what?", "for instance: is FEATURE worse than 2 steps");
  }
  const auto times = [](IntegerVector counts, int n) {
    for (std::size_t k = 0; k < counts.size(); ++k) counts[k] *= n;
    return counts;
  };
  const bool outweighs = !is_alone && middle->text.starts_with("outweigh");
  // In "would it rather" and "prefers" the first side is what it likes more, whatever it costs; in "worse" less.
  const bool is_choice = left.says("rather") || left.says("prefer") || left.says("prefers") || left.says("better") ||
                         left.says("like") || left.says("likes");
  int first = is_choice ? 1 : left.is_cost() ? -1 : 1;
  int second = right.is_cost() ? -1 : right.is_gain() ? 1 : first;
  if (is_choice && !left.says("worth")) second = first;
  if (outweighs || left.says("important") || left.says("matter") || left.says("matters")) {
    first = left.sign();
    second = right.sign();
  }
  const bool says_nothing = left.says("nothing");
  auto difference = times(left.counts(), first) - times(right.counts(), second);
  if (left.says("less") || left.says("fewer") || left.says("cheaper") || says_nothing)
    difference = times(difference, -1);
  if (difference.is_zero()) {
    fail(text, whole, "E1106", "both sides of the comparison are the same", "compare two different things");
  }
  return HalfSpace{difference};
}

}  // namespace kith::detail
