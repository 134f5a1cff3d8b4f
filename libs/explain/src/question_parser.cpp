#include "question_parser.hpp"

#include <algorithm>
#include <set>

#include "comparison.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "question_context.hpp"
#include "question_words.hpp"

namespace kith::detail {
namespace {

class Parser : private ContextReader {
 public:
  Parser(const Domain& domain, const std::string& text) : ContextReader{domain, text} {}

  Question parse() {
    if (const auto sentence = read_sentence(domain_, text_)) {
      question_.kind = Kind::kWhether;
      question_.said = sentence->said;
      question_.condition = sentence->condition;
      return std::move(question_);
    }
    read_kind();
    if (question_.kind == Kind::kWhether) return whether();
    while (at_ < tokens_.size()) read_next();
    close_phrase();
    settle_denial();
    settle_kind();
    check();
    return std::move(question_);
  }

 private:
  using Kind = Question::Kind;

  struct Word {
    std::string text;
    Place place;
  };

  // A question word anywhere, with what stands before it; or a verb at the beginning, which asks when.
  void read_kind() {
    if (tokens_.empty()) {
      fail_at({1, std::max<std::size_t>(text_.size(), 1)}, "E1102", "the question is empty", kForms);
    }
    const auto opening = find_opening(tokens_);
    const auto verb = first_verb(opening ? opening->begin : tokens_.size());
    if (opening && !verb) {
      question_.kind = opening->kind;
      removes_ = opening->removes;
      const bool how_many = question_.kind == Kind::kHowMuch && tokens_[opening->end - 1].text == "many";
      tokens_.erase(tokens_.begin() + static_cast<std::ptrdiff_t>(opening->begin),
                    tokens_.begin() + static_cast<std::ptrdiff_t>(opening->end));
      if (how_many) drop_what_is_counted(opening->begin);
      if (question_.kind == Kind::kWhat && asks_of_a_world(opening->begin)) question_.kind = Kind::kWhatIf;
    } else if (verb) {
      question_.kind = Kind::kWhen;
    } else if (compares(lexicon_, tokens_)) {
      question_.kind = Kind::kWhether;  // said rather than asked
    } else {
      fail_kind();
    }
    negated_ = removes_;
    settle_value();
  }

  // "how many steps is rubble worth" is about rubble, "how many steps does it take" about the whole path.
  void drop_what_is_counted(std::size_t begin) {
    auto end = begin;
    while (end < tokens_.size() && !is_auxiliary(tokens_[end].text) && tokens_[end].text != "in") ++end;
    const bool values =
        std::any_of(tokens_.begin(), tokens_.end(), [](const Token& token) { return speaks_of_value(token.text); });
    bool counts_something = values;
    for (auto i = begin; i < end; ++i) {
      const auto& word = tokens_[i];
      const bool is_known = lexicon_.knows(word.text) || word.text == "moves";
      counts_something = counts_something || is_known;
      if (!values && !is_known && !is_filler(word.text))
        fail_unknown(lexicon_, text_, word.text, word.place, lexicon_.all_words());
    }
    if (!counts_something)
      fail_at({1, 3}, "E1102", "a question with 'how' begins with 'how much' or 'how often'", kForms);
    tokens_.erase(tokens_.begin() + static_cast<std::ptrdiff_t>(begin),
                  tokens_.begin() + static_cast<std::ptrdiff_t>(end));
    // "how many steps would it go to avoid rubble": what that is worth.
    static const std::set<std::string> kSpares{"avoid", "avoiding", "around", "bypass", "skip"};
    const auto spares = [&](const Token& token) { return !values && kSpares.count(token.text) != 0; };
    counts_ = std::erase_if(tokens_, spares) == 0 && !values;
    if (counts_) question_.kind = Kind::kWhat;
  }

  // The verb with which a question begins, if it stands before any question word: "does it recharge".
  [[nodiscard]] std::optional<std::size_t> first_verb(std::size_t end) const {
    for (std::size_t i = 0; i < end; ++i) {
      const auto& token = tokens_[i];
      if (token.kind != Token::Kind::kWord) continue;
      const auto next = i + 1 < tokens_.size() ? tokens_[i + 1].text : std::string{};
      const bool is_to_us = next == "you" || next == "i" || next == "we";  // "could you tell me when"
      if (is_auxiliary(token.text) || (denies(token.text) && token.text.ends_with("n't"))) {
        if (is_to_us) continue;
        return i;
      }
      if (!is_filler(token.text) && !lexicon_.is_only_item(token.text) && token.text != "world") return std::nullopt;
    }
    return std::nullopt;
  }

  [[noreturn]] void fail_kind() const {
    for (const auto& token : tokens_) {
      if (token.text != "how") continue;
      fail_at(token.place, "E1102", "a question with 'how' begins with 'how much' or 'how often'", kForms);
    }
    const auto nearest = nearest_word(tokens_.front().text, {"when", "where", "why", "what", "how", "does", "would"});
    fail_at(tokens_.front().place, "E1102", "a question begins with when, where, why, what, how much, does or would",
            nearest.empty() ? kForms : "did you mean '" + nearest + "'?");
  }

  // "what would it do without the charger", "what happens if".
  [[nodiscard]] bool asks_of_a_world(std::size_t begin) {
    for (auto i = begin; i < tokens_.size(); ++i) {
      const auto& next = tokens_[i].text;
      at_ = i + 1;
      if (next == "with" && names_item_next()) return false;
      at_ = 0;
      if (next == "if" || next == "without" || next == "with") return true;
      if (lexicon_.names_something(next) || !(is_filler(next) || next == "change" || next == "changes")) return false;
    }
    return false;
  }

  // Words for likes and costs turn questions of other kinds into those about the reward: "does it mind rubble".
  void settle_value() {
    if (question_.kind == Kind::kWhatIf) return;
    const bool prefers_here = question_.kind == Kind::kWhy || question_.kind == Kind::kWhere;
    bool values = false;
    for (const auto& token : tokens_) {
      const bool is_choice = token.text == "rather" || token.text.starts_with("prefer") || token.text == "something";
      const bool is_polite = token.text == "like" && &token != tokens_.data() && (&token - 1)->text == "would";
      if (token.kind != Token::Kind::kWord || lexicon_.knows(token.text) || !speaks_of_value(token.text)) continue;
      values = values || !(is_polite || (prefers_here && is_choice) || (opened_by_when() && is_choice));
    }
    if (!values && question_.kind != Kind::kWhether) return;
    values_ = true;
    if (prefers_here) return;
    question_.kind = compares(lexicon_, tokens_) ? Kind::kWhether : Kind::kHowMuch;
  }

  // "when does it prefer the stairs" asks when it takes them, "does it prefer the stairs" what it likes.
  [[nodiscard]] bool opened_by_when() const {
    return question_.kind == Kind::kWhen &&
           (tokens_.empty() || !first_verb(tokens_.size()) || find_opening(tokens_of(text_)).has_value());
  }

  // Of two things that happen one is worth more; of two steps the robot takes one.
  Question whether() {
    const auto left = without_contexts();
    if (auto said = read_comparison(domain_, lexicon_, text_, left)) {
      if (left.size() < tokens_.size())
        fail_at({1, text_.size()}, "E1106", "what things are worth is the same everywhere",
                "leave out place and world");
      question_.said = std::move(said);
      return std::move(question_);
    }
    question_.kind = Kind::kWhat;
    for (at_ = 0; at_ < tokens_.size();) {
      denial_.reset();
      if (lexicon_.names_something(tokens_[at_].text) || speaks_of_value(tokens_[at_].text) ||
          tokens_[at_].text == "than") {
        ++at_;
      } else {
        read_next();
      }
    }
    close_phrase();
    check();
    return std::move(question_);
  }

  // The tokens of a comparison without place and world.
  [[nodiscard]] std::vector<Token> without_contexts() const {
    std::vector<Token> left;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const bool is_number = tokens_[i].kind == Token::Kind::kNumber && i > 0 && tokens_[i - 1].text == "world";
      const auto kind = tokens_[i].kind;
      const bool is_place = kind == Token::Kind::kWorld || kind == Token::Kind::kCell || kind == Token::Kind::kName;
      if (is_place || tokens_[i].text == "world" || is_number) continue;
      left.push_back(tokens_[i]);
    }
    return left;
  }

  // What a question turns out to be once all of it is read.
  void settle_kind() {
    if (question_.kind == Kind::kWhatIf && question_.world && question_.conditions.empty()) {
      question_.kind = Kind::kWhat;  // "what does it do when the lift is broken", of a world that is called so
    }
    const bool is_feature = question_.happening && !question_.happening->action && !question_.instead;
    if (question_.kind == Kind::kWhy && values_ && is_feature && !question_.is_about_a_step()) {
      question_.kind = Kind::kHowMuch;  // "why does it mind rubble": the reward is what there is to tell
    }
    const bool names_nothing = !question_.happening && !question_.instead;
    if (question_.kind == Kind::kWhere && names_nothing && question_.is_about_a_step()) {
      question_.kind = Kind::kWhat;  // "where does it go from (2,3)"
    }
    if (question_.carried && !question_.is_about_a_step() && names_nothing && !map_actions("pickup").empty()) {
      question_.happening = map_actions("pickup").front();  // "does it carry the parcel"
      question_.carried.reset();
    }
  }

  [[nodiscard]] std::vector<Happening> map_actions(const std::string& name) const {
    const bool has = std::ranges::count(domain_.action_names(), name) > 0;
    return has ? lexicon_.happenings({name}) : std::vector<Happening>{};
  }

  void read_next() {
    const Token token = tokens_[at_++];
    const auto& word = token.text;
    if (begins_context(token)) close_phrase();
    if (token.kind == Token::Kind::kCell) return take_cell(token);
    if (token.kind == Token::Kind::kWorld) return set_world(MdpIndex{token.number}, token.place);
    if (token.kind == Token::Kind::kSign || token.kind == Token::Kind::kFraction)
      fail_at(token.place, "E1103", "kith does not know what '" + word + "' says here", kForms);
    if (question_.kind == Kind::kWhatIf && asks_what_then(word)) return skip_what_then();
    if (is_quantity(token)) fail_unknown(lexicon_, text_, word, token.place, lexicon_.all_words());
    if (token.kind == Token::Kind::kName) return take_state(token);
    if (word == "world" || word == "mdp") return take_world(token);
    if (word == "state" && !map_ && !lexicon_.knows(word)) return take_unquoted_state(token);
    if (word == "column" && has_cells() && take_column_and_row(token)) return;
    if (token.kind == Token::Kind::kNumber) return take_number(token);
    static const std::set<std::string> kCarries{"carrying", "carries", "carry", "holding", "holds", "hold"};
    const bool has_item =
        names_item_next() && (kCarries.count(word) != 0 || (word == "with" && question_.kind != Kind::kWhatIf));
    if (has_item) close_phrase();
    if (has_item || word == "carrying") return take_item(token);
    if (is_way_of_speaking(word)) return;
    if (!is_structure(word) && !denies_here(word) && lexicon_.knows(word)) {
      phrase_.push_back({word, token.place});
      return;
    }
    if (denies(word) || denies_here(word)) return deny(word);
    const bool begins_second = is_second_choice(word);
    const bool denies_next = at_ < tokens_.size() && denies(tokens_[at_].text);
    if (word == "but" && !denies_next)
      fail_at(token.place, "E1106", "'but' could mean the opposite", "ask with 'and' or 'not'");
    if (word == "and" || word == "with" || word == "but" || begins_second) {
      close_phrase();
      settle_denial();
      negated_ = begins_second;
      return;
    }
    if ((word == "when" || word == "if") && is_world_next()) return;
    if ((word == "when" || word == "if") && begins_condition()) return begin_condition();
    const bool asks_again = word == "when" || word == "where" || word == "why";
    const bool has_asked = question_.happening || question_.instead || !phrase_.empty();
    const bool follows_up = question_.kind == Kind::kWhatIf || question_.is_about_a_step() || values_;
    if (asks_again && question_.kind != Kind::kWhat && has_asked && !follows_up) {
      fail_at(token.place, "E1106", "one question at a time: '" + word + "' begins another one",
              "ask about it in a question of its own");
    }
    if (is_filler(word) || is_filler_here(word)) {
      if (negated_ && negated_at_ + 1 == at_ - 1) negated_at_ = at_ - 1;  // "does not ever avoid"
      return;
    }
    phrase_.push_back({word, token.place});
  }

  // Whether it says where the robot is, or in which world.
  [[nodiscard]] bool begins_context(const Token& token) const {
    const bool is_place = token.kind != Token::Kind::kWord && token.kind != Token::Kind::kNumber;
    const bool says_state = token.text == "state" && !map_ && !lexicon_.knows(token.text);
    return is_place || token.text == "world" || token.text == "mdp" || token.text == "carrying" || says_state ||
           (token.text == "column" && has_cells()) || is_numbered_state(token);
  }

  // Whether people see cells.
  [[nodiscard]] bool has_cells() const { return domain_.drawing().has_value(); }

  // Words that say how many, or that something is there: what only some kinds of questions ask.
  [[nodiscard]] bool is_quantity(const Token& token) const {
    if (token.kind != Token::Kind::kWord || lexicon_.knows(token.text)) return false;
    const auto before = word_before();
    if (token.text == "all") return question_.kind != Kind::kWhatIf && before != "at" && before != "in";
    if (token.text == "some") return question_.kind == Kind::kWhatIf;
    const auto after = at_ < tokens_.size() ? tokens_[at_].text : std::string{};
    const auto is_being = [](const std::string& word) { return word == "is" || word == "are"; };
    return token.text == "there" && question_.kind != Kind::kWhatIf && (is_being(before) || is_being(after));
  }

  // "if there is no charger, does it go up": what it does then is told by what the condition changes.
  [[nodiscard]] bool asks_what_then(const std::string& word) const {
    const bool has_condition = !phrase_.empty() || !question_.conditions.empty();
    const auto next = at_ < tokens_.size() ? tokens_[at_].text : std::string{};
    return has_condition && is_auxiliary(word) && (next == "it" || next == "the");
  }

  void skip_what_then() {
    close_phrase();
    settle_denial();
    for (; at_ < tokens_.size(); ++at_) {
      const auto& token = tokens_[at_];
      const bool is_word = token.kind == Token::Kind::kWord && (is_filler(token.text) || lexicon_.knows(token.text));
      if (token.kind == Token::Kind::kWorld || token.text == "world") return;
      if (!is_word || denies(token.text)) fail_unknown(lexicon_, text_, token.text, token.place, lexicon_.all_words());
    }
  }

  // A denial must deny something: "the charger was not there".
  void settle_denial() {
    if (!denial_) return;
    const bool is_of_thing = question_.kind == Kind::kWhatIf && question_.conditions.size() == num_settled_ + 1;
    if (!is_of_thing)
      fail_at(*denial_, "E1106", "it is not clear what is denied here", "put the word before what it denies");
    question_.conditions.back().present = false;
    denial_.reset();
    num_settled_ = question_.conditions.size();
  }

  void deny(const std::string& word) {
    if (stem(word) == "around") drop_verbs_of_motion();
    close_phrase();
    // "does not avoid" denies twice, "rather than not" and "instead of not" do not.
    const bool denied_just_before = negated_ && negated_at_ + 1 == at_ - 1;
    const bool says_so_again = word == "off" || word == "away" || word == "past" || word == "clear";
    if (denial_ && !after_instead_ && (says_so_again || !denied_just_before))
      fail_at(tokens_[at_ - 1].place, "E1106", "'" + word + "' denies what is denied already", "deny it once");
    negated_ = !denied_just_before || word == "instead" || word == "than" || after_instead_ || says_so_again;
    after_instead_ = word == "instead" || word == "than";
    negated_at_ = at_ - 1;
    denial_ = tokens_[at_ - 1].place;
  }

  // "prefers left to up": what it does, and what it does not.
  [[nodiscard]] bool is_second_choice(const std::string& word) const {
    if (question_.kind != Kind::kWhy || (word != "to" && word != "over") || phrase_.empty()) return false;
    const bool prefers = std::any_of(tokens_.begin(), tokens_.begin() + static_cast<std::ptrdiff_t>(at_),
                                     [](const Token& token) { return token.text.starts_with("prefer"); });
    return prefers && std::any_of(phrase_.begin(), phrase_.end(),
                                  [&](const Word& one) { return lexicon_.names_something(one.text); });
  }

  [[nodiscard]] std::string word_before() const { return at_ >= 2 ? tokens_[at_ - 2].text : std::string{}; }

  // "keep off", "stay away".
  [[nodiscard]] bool denies_here(const std::string& word) const {
    static const std::set<std::string> kVerbs{"keep", "keeps", "keeping", "stay", "stays", "staying"};
    return word == "off" && kVerbs.count(word_before()) != 0;
  }

  // "end up in the water", "go up the stairs": no action.
  [[nodiscard]] bool is_way_of_speaking(const std::string& word) const {
    if (word != "up" && word != "down") return false;
    if (word_before() == "end" || word_before() == "ends" || word_before() == "ending") return true;
    auto next = at_;
    while (next < tokens_.size() && (tokens_[next].text == "the" || tokens_[next].text == "a")) ++next;
    if (next == at_ || next == tokens_.size() || stem(word_before()) == "pick" || stem(word_before()) == "put")
      return false;
    return lexicon_.names_something(tokens_[next].text);
  }

  void take_number(const Token& token) {
    if (is_numbered_state(token)) return take_state(token);
    fail_at(token.place, "E1103", "it is not clear what the number " + token.text + " stands for",
            "write 'world " + token.text + "'" +
                (map_ ? ", or a cell as (COLUMN,ROW)" : ", or 'state " + token.text + "'"));
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
    static const std::set<std::string> kOfThings{"change",  "changes", "different", "differ", "present",
                                                 "exist",   "exists",  "existed",   "added",  "add",
                                                 "appears", "appear",  "find",      "finds"};
    if (values_ && speaks_of_value(word)) return true;
    return question_.kind == Kind::kWhatIf && kOfThings.count(word) != 0;
  }

  // "does it climb when the lift is broken", of a world that is called so.
  [[nodiscard]] bool is_world_next() const {
    auto next = at_;
    while (next < tokens_.size() && tokens_[next].kind == Token::Kind::kWord && is_filler(tokens_[next].text)) ++next;
    return next < tokens_.size() && tokens_[next].kind == Token::Kind::kWorld;
  }

  // "does it climb if there is no lift": whether all that follows says that a world has or lacks an optional thing.
  [[nodiscard]] bool begins_condition() const {
    const bool has_asked = !phrase_.empty() || question_.happening || question_.instead;
    const bool may_turn = question_.kind == Kind::kWhat || (question_.kind == Kind::kWhen && has_asked);
    bool names_thing = false, says_so = false;
    for (auto i = at_; i < tokens_.size() && tokens_[i].text != "in"; ++i) {
      const auto& word = tokens_[i].text;
      const bool is_thing = lexicon_.optional_thing(word).has_value();
      const bool says_here = denies(word) || is_gone(word) || word == "there";
      if (!is_thing && !says_here && !is_filler(word)) return false;
      names_thing = names_thing || is_thing;
      says_so = says_so || says_here;
    }
    return may_turn && !question_.is_about_a_step() && names_thing && says_so;
  }

  // What it does then is told by what the condition changes.
  void begin_condition() {
    close_phrase();
    if (question_.instead || denial_)
      fail_at(tokens_[at_ - 1].place, "E1106", "a condition takes no 'not' before it", kForms);
    question_.kind = Kind::kWhatIf;
    question_.happening.reset();
    question_.instead.reset();
    negated_ = false;
  }

  [[nodiscard]] bool names_item_next() const {
    auto next = at_;
    while (next < tokens_.size() && is_filler(tokens_[next].text)) ++next;
    return next < tokens_.size() && lexicon_.is_only_item(tokens_[next].text);
  }

  // Ends what stands before a separator, a cell or the end of the question.
  void close_phrase() {
    const bool had_words =
        std::erase_if(phrase_, [&](const Word& word) { return lexicon_.says_only_contact(word.text); });
    if (had_words && question_.instead) denial_.reset();  // "past the charger without stopping"
    if (phrase_.empty()) return;
    const auto place = Place{phrase_.front().place.column,
                             phrase_.back().place.column + phrase_.back().place.length - phrase_.front().place.column};
    if (question_.kind == Kind::kWhatIf) {
      take_condition(place);
    } else if ((question_.kind == Kind::kWhat || question_.is_about_a_step()) && is_item(phrase_)) {
      carry(phrase_.front().text);
    } else {
      take_happening(place);
    }
    phrase_.clear();
  }

  [[nodiscard]] static bool is_gone(const std::string& word) {
    static const std::set<std::string> kGone{"gone",   "missing", "removed",  "remove",    "absent",      "cleared",
                                             "broken", "deleted", "vanished", "disappear", "disappeared", "lacking"};
    return kGone.count(word) != 0;
  }

  // "there is no charger", "the charger is gone", "we remove the charger".
  void take_condition(const Place& place) {
    denial_.reset();
    const bool says_gone = std::erase_if(phrase_, [](const Word& word) { return is_gone(word.text); }) > 0;
    if (phrase_.empty()) {
      if (says_gone && !question_.conditions.empty()) question_.conditions.back().present = negated_;
      return;
    }
    question_.conditions.push_back({negated_ == says_gone, thing_of_phrase(place), std::nullopt, place});
    num_settled_ = question_.conditions.size() - (negated_ || says_gone ? 0 : 1);
  }

  [[nodiscard]] bool is_item(const std::vector<Word>& words) const {
    return std::all_of(words.begin(), words.end(), [&](const Word& word) { return lexicon_.is_only_item(word.text); });
  }

  void carry(const std::string& word) {
    const auto names = map_->item_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (stem(names[i]) == stem(word)) question_.carried = i;
    }
  }

  void take_happening(const Place& place) {
    denial_.reset();
    check_words();
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
    auto& slot = negated_ ? question_.instead : question_.happening;
    const bool is_known = slot && slot->action == found.front().action && slot->feature == found.front().feature;
    if (slot && !is_known) {
      fail_at(place, "E1106", "one thing at a time: '" + phrase_text() + "' is one too many",
              "ask about it in a question of its own");
    }
    slot = found.front();
    slot->place = place;
  }

  // Every word must be one that somebody could use here; the first that is not is named.
  void check_words() const {
    for (const auto& word : phrase_) {
      if (!lexicon_.knows(word.text)) fail_unknown(lexicon_, text_, word.text, word.place, lexicon_.all_words());
    }
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
      if (named && !lexicon_.optional_thing(word.text)) fail_unknown(lexicon_, text_, word.text, word.place, things);
    }
    if (named) return *named;
    const auto nearest = nearest_word(phrase_.front().text, things);
    const auto hint = !nearest.empty() ? "did you mean '" + nearest + "'?"
                      : !map_          ? "without a map, worlds differ as a whole: ask 'in world N'"
                      : things.empty() ? "all its worlds are the same"
                                       : "optional in this domain: " + listed(things);
    fail_at(place, "E1108", "'" + phrase_text() + "' is not optional in this domain", hint);
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
    const bool is_about_a_path = counts_ || question_.world || domain_.num_mdps() == 1;
    if (!question_.is_about_a_step() && !is_about_a_path) fail_at(whole, "E1106", "what does it do where?", kForms);
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

  bool negated_ = false;
  bool after_instead_ = false;
  bool removes_ = false;         // "what difference does ... make"
  bool values_ = false;          // it is about what something is worth
  bool counts_ = false;          // "how many steps does it take"
  std::size_t negated_at_ = 0;   // position of the last word that denied
  std::optional<Place> denial_;  // of a word that denied, as long as it denies nothing
  std::size_t num_settled_ = 0;  // conditions that say whether the thing is there
  std::vector<Word> phrase_;
};

}  // namespace

void fail(const std::string& question, const Place& place, const std::string& id, const std::string& message,
          const Advice& advice) {
  Diagnostic diagnostic;
  diagnostic.id = id;
  diagnostic.message = message;
  diagnostic.file = "question";
  diagnostic.line = 1;
  diagnostic.column = place.column;
  diagnostic.length = place.length;
  diagnostic.hint = advice.hint;
  diagnostic.remedy = advice.remedy;
  diagnostic.source_line = question;
  throw Error{ErrorKind::kInvalidInput, message, {diagnostic}};
}

Question parse_question(const Domain& domain, const std::string& text) { return Parser{domain, text}.parse(); }

}  // namespace kith::detail
