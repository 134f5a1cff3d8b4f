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

// Also of words in other scripts, which are then unknown words rather than none.
bool is_letter(unsigned char c) {
  constexpr unsigned char kLastAscii = 0x7F;
  return c > kLastAscii || std::isalnum(c) != 0;
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
      return digit ? std::isdigit(c) != 0 : is_letter(c) || c == '_' || c == '-' || c == '\'';
    };
    if (const auto end = end_of_name(text, i)) {
      tokens.push_back({Token::Kind::kName, text.substr(i + 1, *end - i - 1), 0, 0, {i + 2, *end - i - 1}});
      i = *end + 1;
      comma = false;
      continue;
    }
    if (!is(i, [](unsigned char c) { return is_letter(c); })) {
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

  // "Does it recharge?" asks when it does; "how much does rubble cost?" what can be concluded about its weight.
  void read_kind() {
    if (tokens_.empty()) {
      fail_at({1, std::max<std::size_t>(text_.size(), 1)}, "E1102", "the question is empty", kForms);
    }
    static const std::set<std::string> kAuxiliaries{"does", "do",  "did",   "is",     "are",  "will",
                                                    "can",  "may", "could", "should", "would"};
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const auto& word = tokens_[i].text;
      at_ = i + 1;
      if (is_question_word(word)) return read_question_word(word);
      if (word == "how") return read_how(tokens_[i]);
      if (!is_filler(word)) break;
    }
    if (kAuxiliaries.count(tokens_.front().text) != 0) {
      at_ = 1;
      question_.kind = Kind::kWhen;
      return;
    }
    const auto nearest = nearest_word(tokens_.front().text, {"when", "where", "why", "what", "how"});
    fail_at(tokens_.front().place, "E1102", "a question begins with when, where, why, what or how much",
            nearest.empty() ? kForms : "did you mean '" + nearest + "'?");
  }

  static bool is_question_word(const std::string& word) {
    return word == "when" || word == "where" || word == "why" || word == "what";
  }

  void read_question_word(const std::string& word) {
    question_.kind = word == "when"    ? Kind::kWhen
                     : word == "where" ? Kind::kWhere
                     : word == "why"   ? Kind::kWhy
                                       : Kind::kWhat;
    if (word != "what") return;
    // "what if", "what happens if", "what would it do without".
    for (auto i = at_; i < tokens_.size(); ++i) {
      const auto& next = tokens_[i].text;
      if (next == "if" || next == "without" || next == "with") {
        question_.kind = Kind::kWhatIf;
        at_ = next == "if" ? i + 1 : i;
        return;
      }
      if (lexicon_.knows(next) || !is_filler(next)) return;
    }
  }

  void read_how(const Token& how) {
    const auto next = at_ < tokens_.size() ? tokens_[at_].text : std::string{};
    if (next != "much" && next != "often") {
      fail_at(how.place, "E1102", "a question with 'how' begins with 'how much' or 'how often'", kForms);
    }
    ++at_;
    question_.kind = next == "much" ? Kind::kHowMuch : Kind::kWhen;
  }

  // Words that deny what follows: "not", "doesn't", "avoid".
  static bool denies(const std::string& word) {
    static const std::set<std::string> kWords{"not",      "no",    "never",  "without",  "cannot", "instead",
                                              "than",     "avoid", "avoids", "avoiding", "around", "bypass",
                                              "bypasses", "skip",  "skips",  "skipping"};
    return kWords.count(word) != 0 || (word.size() > 3 && word.substr(word.size() - 3) == "n't");
  }

  void read_next() {
    const Token token = tokens_[at_++];
    const auto& word = token.text;
    if (token.kind == Token::Kind::kCell) return take_cell(token);
    if (token.kind == Token::Kind::kName) return take_state(token);
    if (word == "world" || word == "mdp") return take_world(token);
    if (word == "state" && !domain_.has_map() && !lexicon_.knows(word)) return take_unquoted_state(token);
    if (token.kind == Token::Kind::kNumber) {
      fail_at(token.place, "E1103", "it is not clear what the number " + word + " stands for",
              "write 'world " + word + "', or a cell as (COLUMN,ROW)");
    }
    if (word == "carrying") return take_item(token);
    if (word == "with" && question_.kind != Kind::kWhatIf && names_item_next()) return take_item(token);
    if (!is_structure(word) && lexicon_.knows(word)) {
      phrase_.push_back({word, token.place});
      return;
    }
    if (denies(word)) {
      if (stem(word) == "around") drop_verbs_of_motion();
      close_phrase();
      // "does not avoid" denies twice, "rather than not" and "instead of not" do not.
      const bool denied_just_before = negated_ && negated_at_ + 1 == at_ - 1;
      negated_ = !denied_just_before || word == "instead" || word == "than" || after_instead_;
      after_instead_ = word == "instead" || word == "than";
      negated_at_ = at_ - 1;
      return;
    }
    if (word == "and" || word == "with" || word == "but") {
      close_phrase();
      negated_ = false;
      return;
    }
    if (is_question_word(word) && question_.kind != Kind::kWhat) {
      fail_at(token.place, "E1106", "one question at a time: '" + word + "' begins another one",
              "ask about it in a question of its own");
    }
    if (is_filler(word) || is_filler_here(word)) {
      if (negated_ && negated_at_ + 1 == at_ - 1) negated_at_ = at_ - 1;  // "does not ever avoid"
      return;
    }
    phrase_.push_back({word, token.place});
  }

  // Words that hold a question together, whatever words a domain uses.
  static bool is_structure(const std::string& word) {
    static const std::set<std::string> kWords{"not", "no", "never", "without", "instead", "than", "and", "with", "but"};
    return kWords.count(word) != 0;
  }

  // "step around the rubble", "drive around people": only how it moves.
  void drop_verbs_of_motion() {
    static const std::set<std::string> kStems{"step", "driv", "walk", "cros", "go", "mov", "run"};
    std::erase_if(phrase_, [](const Word& word) { return kStems.count(stem(word.text)) != 0; });
  }

  // Words that say nothing in questions of one kind.
  [[nodiscard]] bool is_filler_here(const std::string& word) const {
    static const std::set<std::string> kOfCosts{"cost",    "costs", "worth", "mind",     "minds",  "like",    "likes",
                                                "dislike", "want",  "wants", "dislikes", "matter", "matters", "value"};
    static const std::set<std::string> kOfThings{"everywhere", "anywhere", "change", "changes", "all"};
    if (question_.kind == Kind::kHowMuch) return kOfCosts.count(word) != 0;
    return question_.kind == Kind::kWhatIf && kOfThings.count(word) != 0;
  }

  [[nodiscard]] bool names_item_next() const {
    auto next = at_;
    while (next < tokens_.size() && is_filler(tokens_[next].text)) ++next;
    return next < tokens_.size() && lexicon_.is_only_item(tokens_[next].text);
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
    check_words();
    auto& slot = negated_ ? question_.instead : question_.happening;
    if (slot) {
      fail_at(place, "E1106", "one thing at a time: '" + phrase_text() + "' is one too many",
              "ask about it in a question of its own");
    }
    const auto found = lexicon_.happenings(words_of_phrase());
    if (found.empty()) {
      fail_at(place, "E1103", "'" + phrase_text() + "' is neither an action nor a feature of this robot",
              "kith knows " + listed(lexicon_.happening_names()));
    }
    if (found.size() > 1) {
      std::vector<std::string> names;
      names.reserve(found.size());
      for (const auto& one : found) names.push_back(lexicon_.name_of(one));
      fail_at(place, "E1103", "'" + phrase_text() + "' could mean several things: " + listed(names),
              "use one of these names");
    }
    slot = found.front();
    slot->place = place;
  }

  // Every word must be one that somebody could use here; the first that is not is named.
  void check_words() const {
    for (const auto& word : phrase_) {
      if (!lexicon_.knows(word.text)) fail_unknown(word.text, word.place, lexicon_.all_words());
    }
  }

  [[noreturn]] void fail_unknown(const std::string& word, const Place& place,
                                 const std::vector<std::string>& candidates) const {
    const auto nearest = nearest_word(word, candidates);
    fail_at(place, "E1103", "kith does not know the word '" + word + "'",
            nearest.empty() ? "it knows " + listed(lexicon_.happening_names()) : "did you mean '" + nearest + "'?");
  }

  [[nodiscard]] std::string thing_of_phrase(const Place& place) const {
    const auto things = lexicon_.optional_things();
    std::optional<std::string> named;
    for (const auto& word : phrase_) {
      const auto thing = lexicon_.optional_thing(word.text);
      if (thing && named && thing != named) {
        fail_at(word.place, "E1106", "two things in one: '" + phrase_text() + "'", "put 'and' between them");
      }
      if (thing) named = thing;
    }
    for (const auto& word : phrase_) {
      if (named && !lexicon_.optional_thing(word.text)) fail_unknown(word.text, word.place, things);
    }
    if (named) return *named;
    const auto nearest = nearest_word(phrase_.front().text, things);
    const auto hint = !nearest.empty()     ? "did you mean '" + nearest + "'?"
                      : !domain_.has_map() ? "without a map, worlds differ as a whole: ask 'in world N'"
                      : things.empty()     ? "all its worlds are the same"
                                           : "optional in this domain: " + listed(things);
    fail_at(place, "E1108", "'" + phrase_text() + "' is not optional in this domain", hint);
  }

  // "state 0", "state on the bank at a1": the longest stretch of words that is a name, or the next word.
  void take_unquoted_state(const Token& word) {
    if (at_ >= tokens_.size())
      fail_at(word.place, "E1104", "which state?", "write its name, as kith inspect prints it");
    if (tokens_[at_].kind == Token::Kind::kName) return;  // quoted after all
    const auto names = state_names();
    const auto begin = tokens_[at_].place.column - 1;
    for (auto last = tokens_.size(); last-- > at_;) {
      const auto end = tokens_[last].place.column - 1 + tokens_[last].place.length;
      auto name = text_.substr(begin, end - begin);
      if (names.count(name) == 0) name.insert(0, "state ");
      if (names.count(name) == 0 && last > at_) continue;
      Token found{Token::Kind::kName, names.count(name) != 0 ? name : text_.substr(begin, end - begin), 0, 0, {}};
      found.place = {begin + 1, end - begin};
      at_ = last + 1;
      return take_state(found);
    }
  }

  [[nodiscard]] std::set<std::string> state_names() const {
    std::set<std::string> names;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      for (StateIndex s{0}; s.value() < domain_.mdp(m).num_states(); ++s) names.insert(domain_.state_name(m, s));
    }
    return names;
  }

  // The name of a state, in models without a map.
  void take_state(const Token& token) {
    close_phrase();
    if (domain_.has_map()) {
      fail_at(token.place, "E1104", "states have no names in a domain with a map",
              "name a cell: (COLUMN,ROW), or an action or a feature without quotes");
    }
    const auto names = state_names();
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
      fail_at(token.place, "E1104", "this domain has no map, so there are no cells",
              "name a state in quotes, as kith inspect prints it");
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
            names.empty() ? "there is nothing to carry in this domain" : "it can carry " + listed(names));
  }

  void check() {
    const Place whole{1, std::max<std::size_t>(text_.size(), 1)};
    const auto missing = [&](const std::string& what) { fail_at(whole, "E1106", what, kForms); };
    const bool asks_worlds = question_.kind == Kind::kWhen || question_.kind == Kind::kWhere;
    if (asks_worlds && question_.happening && question_.instead) {
      fail_at(question_.instead->place, "E1106", "'when' and 'where' take one thing that happens, or does not",
              "ask about the other one in a question of its own");
    }
    // "When does it not recharge?" asks for the worlds in which it does not.
    if (asks_worlds && !question_.happening) {
      std::swap(question_.happening, question_.instead);
      question_.negated = question_.happening.has_value();
    }
    if (question_.kind == Kind::kWhen && !question_.happening) missing("when does what happen?");
    if (question_.kind == Kind::kWhere && !question_.happening) missing("where does what happen?");
    const bool says_where = question_.is_about_a_step();
    if (question_.kind == Kind::kWhy && !question_.happening && !question_.instead && !says_where) {
      missing("why what?");
    }
    if (question_.kind == Kind::kWhatIf && question_.conditions.empty()) missing("what if what?");
    if (question_.kind == Kind::kWhat) check_what();
    if (question_.kind == Kind::kHowMuch) check_how_much();
    if (question_.carried && !says_where) missing("carrying it where? Name a cell");
  }

  void check_what() const {
    const Place whole{1, std::max<std::size_t>(text_.size(), 1)};
    if (const auto& extra = question_.happening ? question_.happening : question_.instead) {
      fail_at(extra->place, "E1106", "'what' asks for the next step and takes only a cell, an item and a world",
              "ask 'when' or 'why' about " + lexicon_.name_of(*extra));
    }
    if (!question_.is_about_a_step()) fail_at(whole, "E1106", "what does it do where?", kForms);
  }

  void check_how_much() const {
    const Place whole{1, std::max<std::size_t>(text_.size(), 1)};
    if (!question_.happening || question_.happening->action) {
      fail_at(question_.happening ? question_.happening->place : whole, "E1106", "how much does which feature count?",
              "its features are " + listed(domain_.feature_names()));
    }
    if (question_.instead || question_.is_about_a_step() || question_.world) {
      fail_at(whole, "E1106", "'how much' takes only a feature: its weight is the same everywhere",
              "for instance: how much " + lexicon_.name_of(*question_.happening));
    }
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
      "ask for instance 'when up', 'where up', 'why up not left at (2,1)', 'what at (2,1)', 'what if no wall' or "
      "'how much step'";

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
  bool after_instead_ = false;
  std::size_t negated_at_ = 0;  // position of the last word that denied
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
