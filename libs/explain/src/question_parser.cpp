#include "question_parser.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "lexicon.hpp"

namespace kith::detail {
namespace {

struct Token {
  enum class Kind { kWord, kNumber, kCell, kName };
  Kind kind = Kind::kWord;
  std::string text;  // lower case, except for names
  std::size_t number = 0, row = 0;
  Place place;
};

// Words that may stand anywhere and say nothing.
bool is_filler(const std::string& word) { return filler_words().count(word) != 0; }

std::size_t number_of(const std::string& digits) {
  constexpr std::size_t kMaxDigits = 9;
  return digits.size() > kMaxDigits ? 1'000'000'000 : static_cast<std::size_t>(std::stoul(digits));
}

// The end of a name in quotes that begin at `i`, or nothing: "'" also stands within words.
std::optional<std::size_t> end_of_name(const std::string& text, std::size_t i) {
  if (text[i] != '"' && text[i] != '\'') return std::nullopt;
  const auto end = text.find(text[i], i + 1);
  return end == std::string::npos || end == i + 1 ? std::nullopt : std::optional{end};
}

// Words, numbers, cells and names in quotes; whatever else is there separates them.
std::vector<Token> tokens_of(const std::string& text) {
  const auto is = [&](std::size_t i, auto predicate) {
    return i < text.size() && predicate(static_cast<unsigned char>(text[i])) != 0;
  };
  std::vector<Token> tokens;
  bool comma = false;  // between the last token and this one
  for (std::size_t i = 0; i < text.size();) {
    const bool digit = is(i, [](unsigned char c) { return std::isdigit(c); });
    const auto belongs = [digit](unsigned char c) {
      return digit ? std::isdigit(c) != 0 : std::isalnum(c) != 0 || c == '_' || c == '-' || c == '\'';
    };
    if (const auto end = end_of_name(text, i)) {
      tokens.push_back({Token::Kind::kName, text.substr(i + 1, *end - i - 1), 0, 0, {i + 2, *end - i - 1}});
      i = *end + 1;
      comma = false;
      continue;
    }
    if (!is(i, [](unsigned char c) { return std::isalnum(c); })) {
      comma = comma || text[i] == ',';
      ++i;
      continue;
    }
    const auto begin = i;
    while (is(i, belongs)) ++i;
    Token token;
    token.place = {begin + 1, i - begin};
    for (const char c : text.substr(begin, i - begin)) {
      token.text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (digit) {
      token.kind = Token::Kind::kNumber;
      token.number = number_of(token.text);
    }
    const bool pair = digit && comma && !tokens.empty() && tokens.back().kind == Token::Kind::kNumber;
    if (pair) {
      tokens.back().kind = Token::Kind::kCell;
      tokens.back().row = token.number;
      tokens.back().place.length = i + 1 - tokens.back().place.column;
    } else {
      tokens.push_back(token);
    }
    comma = false;
  }
  return tokens;
}

class Parser {
 public:
  Parser(const Domain& domain, const std::string& text)
      : domain_{domain}, text_{text}, lexicon_{domain}, tokens_{tokens_of(text)} {}

  Question parse() {
    read_kind();
    while (at_ < tokens_.size()) read_next();
    close_phrase();
    check();
    return std::move(question_);
  }

 private:
  using Kind = Question::Kind;

  [[noreturn]] void fail_at(const Place& place, const std::string& id, const std::string& message,
                            const std::string& hint = {}) const {
    fail(text_, place, id, message, hint);
  }

  void read_kind() {
    if (tokens_.empty()) {
      fail_at({1, std::max<std::size_t>(text_.size(), 1)}, "E1102", "this asks nothing", kForms);
    }
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const auto& word = tokens_[i].text;
      if (word == "when" || word == "where" || word == "why" || word == "what") {
        at_ = i + 1;
        question_.kind = word == "when"    ? Kind::kWhen
                         : word == "where" ? Kind::kWhere
                         : word == "why"   ? Kind::kWhy
                                           : Kind::kWhat;
        const bool has_if =
            word == "what" && at_ < tokens_.size() &&
            (tokens_[at_].text == "if" || tokens_[at_].text == "without" || tokens_[at_].text == "with");
        if (has_if) question_.kind = Kind::kWhatIf;
        if (has_if && tokens_[at_].text == "if") ++at_;
        return;
      }
      if (!is_filler(word)) break;
    }
    const auto nearest = nearest_word(tokens_.front().text, {"when", "where", "why", "what"});
    fail_at(tokens_.front().place, "E1102", "a question begins with when, where, why or what",
            nearest.empty() ? kForms : "did you mean '" + nearest + "'?");
  }

  void read_next() {
    const Token token = tokens_[at_++];
    const auto& word = token.text;
    if (token.kind == Token::Kind::kCell) return take_cell(token);
    if (token.kind == Token::Kind::kName) return take_state(token);
    if (word == "world" || word == "mdp") return take_world(token);
    if (token.kind == Token::Kind::kNumber) {
      fail_at(token.place, "E1103", "it is not clear what " + word + " numbers",
              "write 'world " + word + "', or a cell as (COLUMN,ROW)");
    }
    if (word == "carrying") return take_item(token);
    const bool negation = word == "not" || word == "no" || word == "without" || word == "instead" || word == "rather" ||
                          (word.size() > 3 && word.substr(word.size() - 3) == "n't");
    const bool separator = negation || word == "and" || word == "with";
    if (!separator && !lexicon_.knows(word) && is_filler(word)) return;
    if (separator) {
      close_phrase();
      negated_ = negation;
      return;
    }
    phrase_.push_back({word, token.place});
  }

  // Ends what stands before a separator, a cell or the end of the question.
  void close_phrase() {
    if (phrase_.empty()) return;
    const auto place = Place{phrase_.front().place.column,
                             phrase_.back().place.column + phrase_.back().place.length - phrase_.front().place.column};
    if (question_.kind == Kind::kWhatIf) {
      question_.conditions.push_back({!negated_, thing_of_phrase(place), std::nullopt, place});
    } else {
      take_happening(place);
    }
    phrase_.clear();
  }

  void take_happening(const Place& place) {
    auto& slot = negated_ ? question_.instead : question_.happening;
    if (slot) {
      fail_at(place, "E1106", "one thing at a time: '" + phrase_text() + "' is one too many",
              "ask about it in a question of its own");
    }
    check_words(place);
    const auto found = lexicon_.happenings(words_of_phrase());
    if (found.empty()) {
      fail_at(place, "E1103", "'" + phrase_text() + "' is no action and no feature of this robot",
              "it knows " + listed(lexicon_.happening_names()));
    }
    if (found.size() > 1) {
      std::vector<std::string> names;
      for (const auto& one : found) names.push_back(lexicon_.name_of(one));
      fail_at(place, "E1103", "'" + phrase_text() + "' could mean several things: " + listed(names),
              "say more, or its name");
    }
    slot = found.front();
    slot->place = place;
  }

  // Every word must be one that somebody could use here; the first that is not is named.
  void check_words(const Place&) const {
    for (const auto& word : phrase_) {
      if (lexicon_.knows(word.text)) continue;
      const auto nearest = nearest_word(word.text, lexicon_.all_words());
      fail_at(word.place, "E1103", "nobody knows '" + word.text + "' here",
              nearest.empty() ? "the robot knows " + listed(lexicon_.happening_names())
                              : "did you mean '" + nearest + "'?");
    }
  }

  std::string thing_of_phrase(const Place& place) const {
    for (const auto& word : phrase_) {
      if (const auto thing = lexicon_.optional_thing(word.text)) return *thing;
    }
    const auto things = lexicon_.optional_things();
    const auto nearest = nearest_word(phrase_.front().text, things);
    const auto hint = !nearest.empty()     ? "did you mean '" + nearest + "'?"
                      : !domain_.has_map() ? "without a map worlds differ as a whole: ask 'in world N'"
                      : things.empty()     ? "all its worlds are the same"
                                           : "these may be there or not: " + listed(things);
    fail_at(place, "E1108", "'" + phrase_text() + "' is nothing that worlds may have or lack", hint);
  }

  // The name of a state, in models without a map.
  void take_state(const Token& token) {
    close_phrase();
    if (domain_.has_map()) {
      fail_at(token.place, "E1104", "this robot has a map, on which states have no names",
              "name a cell: (COLUMN,ROW), or an action or a feature without quotes");
    }
    std::set<std::string> names;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      for (StateIndex s{0}; s.value() < domain_.mdp(m).num_states(); ++s) names.insert(domain_.state_name(m, s));
    }
    question_.spot = token.place;
    question_.state = token.text;
    if (names.count(token.text) > 0) return;
    // Part of a name will do, if it is part of no other.
    std::vector<std::string> found;
    for (const auto& name : names) {
      if (name.find(token.text) != std::string::npos) found.push_back(name);
    }
    if (found.size() == 1) {
      question_.state = found.front();
      return;
    }
    fail_at(token.place, "E1104",
            found.empty() ? "there is no state '" + token.text + "' in which the robot has a choice"
                          : "'" + token.text + "' could be " + std::to_string(found.size()) + " states",
            hint_of_states(token.text, found.empty() ? std::vector<std::string>{names.begin(), names.end()} : found));
  }

  static std::string hint_of_states(const std::string& name, const std::vector<std::string>& names) {
    constexpr std::size_t kListed = 8;
    constexpr std::size_t kMostCompared = 5'000;  // comparing with more takes too long
    const auto nearest = names.size() > kMostCompared ? "" : nearest_word(name, names);
    if (!nearest.empty()) return "did you mean '" + nearest + "'?";
    return names.size() > kListed ? "kith inspect names the states of an MDP" : "its states are " + listed(names);
  }

  void take_cell(const Token& token) {
    close_phrase();
    if (!domain_.has_map()) {
      fail_at(token.place, "E1104", "this robot has no map, so there are no cells",
              "name a state in quotes, as kith inspect shows it");
    }
    const Cell cell{static_cast<int>(token.number), domain_.height() + 1 - static_cast<int>(token.row)};
    if (token.number < 1 || token.number > static_cast<std::size_t>(domain_.width()) || token.row < 1 ||
        token.row > static_cast<std::size_t>(domain_.height())) {
      fail_at(token.place, "E1104",
              "the map has no cell (" + std::to_string(token.number) + "," + std::to_string(token.row) + ")",
              "it has " + std::to_string(domain_.width()) + " columns and " + std::to_string(domain_.height()) +
                  " rows, counted from the top left, from 1");
    }
    if (question_.kind == Kind::kWhatIf && !question_.conditions.empty()) {
      question_.conditions.back().cell = cell;
      return;
    }
    question_.cell = cell;
    question_.spot = token.place;
  }

  void take_world(const Token& token) {
    close_phrase();
    if (at_ >= tokens_.size() || tokens_[at_].kind != Token::Kind::kNumber) {
      fail_at(token.place, "E1105", "which world?", "write its number, 0 to " + std::to_string(domain_.num_mdps() - 1));
    }
    const Token number = tokens_[at_++];
    if (number.number >= domain_.num_mdps()) {
      fail_at(number.place, "E1105", "there is no world " + number.text,
              "they are numbered 0 to " + std::to_string(domain_.num_mdps() - 1));
    }
    question_.world = MdpIndex{number.number};
  }

  void take_item(const Token& token) {
    close_phrase();
    while (at_ < tokens_.size() && is_filler(tokens_[at_].text)) ++at_;
    const auto& names = domain_.item_names();
    if (at_ < tokens_.size()) {
      const auto& word = tokens_[at_].text;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (stem(names[i]) != stem(word)) continue;
        ++at_;
        question_.carried = i;
        return;
      }
    }
    fail_at(at_ < tokens_.size() ? tokens_[at_].place : token.place, "E1103", "carrying what?",
            names.empty() ? "there is nothing to carry here" : "it can carry " + listed(names));
  }

  void check() {
    // "When does it not recharge?" asks for the same worlds, in which it does and in which it does not.
    const bool asks_worlds = question_.kind == Kind::kWhen || question_.kind == Kind::kWhere;
    if (asks_worlds && !question_.happening) std::swap(question_.happening, question_.instead);
    const Place whole{1, std::max<std::size_t>(text_.size(), 1)};
    const auto missing = [&](const std::string& what) { fail_at(whole, "E1106", what, kForms); };
    if (question_.kind == Kind::kWhen && !question_.happening) missing("when does what happen?");
    if (question_.kind == Kind::kWhere && !question_.happening) missing("where does what happen?");
    const bool says_where = question_.is_about_a_step();
    if (question_.kind == Kind::kWhy && !question_.happening && !question_.instead && !says_where) {
      missing("why what?");
    }
    if (question_.kind == Kind::kWhatIf && question_.conditions.empty()) missing("what if what?");
    if (question_.kind == Kind::kWhat && !says_where) missing("what does it do where?");
    if (question_.carried && !says_where) missing("carrying it where? Name a cell");
  }

  [[nodiscard]] std::vector<std::string> words_of_phrase() const {
    std::vector<std::string> words;
    for (const auto& word : phrase_) words.push_back(word.text);
    return words;
  }
  [[nodiscard]] std::string phrase_text() const {
    std::string text;
    for (const auto& word : phrase_) text += (text.empty() ? "" : " ") + word.text;
    return text;
  }

  static constexpr const char* kForms =
      "ask, for instance, 'when up', 'where up', 'why up not left at (2,1)', 'what at (2,1)' or 'what if no wall'";

  struct Word {
    std::string text;
    Place place;
  };
  const Domain& domain_;
  const std::string& text_;
  Lexicon lexicon_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  bool negated_ = false;
  std::vector<Word> phrase_;
  Question question_;
};

}  // namespace

void fail(const std::string& question, const Place& place, const std::string& id, const std::string& message,
          const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.id = id;
  diagnostic.message = message;
  diagnostic.file = "question";
  diagnostic.line = 1;
  diagnostic.column = place.column;
  diagnostic.length = place.length;
  diagnostic.hint = hint;
  diagnostic.source_line = question;
  throw Error{ErrorKind::kInvalidInput, message, {diagnostic}};
}

Question parse_question(const Domain& domain, const std::string& text) { return Parser{domain, text}.parse(); }

}  // namespace kith::detail
