// The grammar of questions. [] is optional, {} may be repeated; a word between quotes stands for all that mean the
// same.
//
//   question  := claim | "when" | "where" | "why" | "what" | "if" | "how much" | "how many" | "does it", each with its
//   rule events    := event {("and" | "rather than" | "not") event} event     := {"not" | "avoid"} NAME {NAME} when :=
//   events ["if" condition]                                 also of "where" and "does it" why       := events one that
//   happens, one that does not what      := [("if" | "with" | "without") condition] if        := condition [("does it"
//   when) | ("what would it do")] condition := ["no"] THING [CELL] ["is gone" | "is not there"] {"and" condition} how
//   much  := {VALUE | NAME}
//
// A world, a place and a thing to carry may be said anywhere.
#include "question_parser.hpp"

#include <algorithm>

#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "question_reader.hpp"

namespace kith::detail {
namespace {

using enum Meaning;

constexpr Meanings kValues = one_of(kCost, kGain, kCostOf, kGainOf, kMatter, kWorse, kBetter, kValue, kRather);

class Parser {
 public:
  Parser(const Domain& domain, const std::string& text) : reader_{domain, text} {}

  Question parse() {
    question();
    reader_.finish(question_);
    check();
    return std::move(question_);
  }

 private:
  using Kind = Question::Kind;
  using Words = std::vector<Token>;

  // --- one rule for each way to begin ---------------------------------------
  void question() {
    if (takes(kWhy)) return why();
    if (takes(kWhere)) return when(Kind::kWhere);
    if (takes(kWhen)) return when(Kind::kWhen);
    if (sees_claim(reader_)) return claim();
    if (takes(kDifference)) return condition(false);
    if (takes(kIf)) return condition_first();
    if (takes(kHowMuch)) return how_much();
    if (takes(kHowMany)) return how_many();
    if (takes(kWhat)) return what();
    if (takes(kWhether, kAux)) return says_value() ? how_much() : when(Kind::kWhen);
    fail_to_begin();
  }

  // "is rubble worse than 2 steps"; "if coming home is worth something, 3 steps cost something".
  void claim() {
    question_.kind = Kind::kWhether;
    takes(kWhether);
    if (takes(kIf)) question_.condition = read_claim(reader_);
    question_.said = read_claim(reader_);
  }

  void when(Kind kind) {
    question_.kind = kind;
    events();
    if (takes(kIf, kWhen) && !is_a_world()) conditions(true);
  }

  void why() {
    question_.kind = Kind::kWhy;
    events();
  }

  // "what does it do at (2,1)", "what happens if there is no charger", "what does it cost to go up".
  void what() {
    question_.kind = Kind::kWhat;
    while (takes(kChange)) continue;
    if (says_value()) return how_much();
    if (takes(kWithout)) return condition(false);
    if (takes(kWith)) return condition(true);
    if (takes(kIf, kWhen) && !is_a_world()) return condition(true);
    while (const auto name = reader_.take_name()) refuse_name(*name);
  }

  void condition(bool present) {
    question_.kind = Kind::kWhatIf;
    conditions(present);
  }

  // "if there were no charger, what would it do", "if there is rubble at (4,2), does it recharge".
  void condition_first() {
    reader_.stop_before(where_it_goes_on());
    condition(true);
    reader_.refuse_what_is_left();
    reader_.read_to_the_end();
    if (takes(kWhat) || reader_.is_done()) return;
    if (takes(kAux)) return when(Kind::kWhen);
  }

  void how_much() {
    question_.kind = Kind::kHowMuch;
    Words words;
    for (;;) {
      if (const auto name = reader_.take_name()) {
        words.push_back(*name);
      } else if (!reader_.takes(kValues)) {
        break;
      }
    }
    name_event(words, false);
  }

  // "how many steps is rubble worth", "how many steps would it go to avoid rubble", "how many steps in world 7".
  void how_many() {
    bool counts = false;
    for (; reader_.at() < reader_.tokens().size(); reader_.go_to(reader_.at() + 1)) {
      const auto& token = reader_.tokens()[reader_.at()];
      const bool is_counted = token.kind == Token::Kind::kName || means(token.meanings, kMoves);
      if (!is_counted && (means(token.meanings, kAux) || !means(token.meanings, kFiller))) break;
      counts = counts || is_counted;
    }
    if (!counts) {
      reader_.refuse_what_is_left();
      fail({1, 3}, "E1102", "a question with 'how' begins with 'how much' or 'how often'", Reader::kForms);
    }
    if (says_value() || takes(kAvoid)) return how_much();
    counts_ = true;
    what();
  }

  // --- what happens -----------------------------------------------------------
  void events() {
    event(false);
    for (;;) {
      const auto at = reader_.at();
      if (takes(kBut) && !reader_.sees(one_of(kNot))) return reader_.go_to(at);
      const bool denies = takes(kInstead, kNot) || (prefers_ && takes(kTo));
      if (!denies && !takes(kAnd)) return;
      if (reader_.is_done()) missing("and what, or not what?");
      event(denies);
    }
  }

  void event(bool denied) {
    Words words;
    for (;;) {
      const bool begins = says_only_contact(words);
      if (begins && takes(kAvoid)) {
        words.clear();  // "drive around": only how it moves
        denied = !denied;
      } else if (begins && takes(kNot)) {
        denied = !denied;
      } else if (const auto rather = reader_.take(one_of(kRather))) {
        prefers_ = question_.kind == Kind::kWhy && rather->text.starts_with("prefer");
      } else if (question_.kind == Kind::kWhy && reader_.takes(kValues)) {
        values_ = true;
      } else if (const auto name = reader_.take_name(prefers_ && !begins ? one_of(kTo) : 0)) {
        words.push_back(*name);
      } else {
        break;
      }
    }
    name_event(words, denied);
  }

  // What words name together, in its place; how the robot moves is no matter.
  void name_event(Words words, bool denied) {
    const bool said_something = !words.empty();
    std::erase_if(words, [&](const Token& word) { return reader_.lexicon().says_only_contact(word.text); });
    if (words.empty()) {
      const bool says_it_again = said_something && denied && question_.instead;  // "past the charger without stopping"
      if (!denied || says_it_again) return;
      reader_.refuse_what_is_left();
      fail(reader_.whole(), "E1106", "it is not clear what is denied here", "put the word before what it denies");
    }
    const auto place = place_of(words);
    const auto found = reader_.lexicon().happenings(texts_of(words));
    if (found.empty()) {
      fail(place, "E1103", "'" + phrase(words) + "' is neither an action nor a feature of this robot",
           "kith knows " + listed(reader_.lexicon().happening_names()));
    }
    if (found.size() > 1) {
      std::vector<std::string> names;
      for (const auto& one : found) names.push_back(reader_.lexicon().name_of(one));
      fail(place, "E1103", "'" + phrase(words) + "' could mean several things: " + listed(names),
           "use one of these names");
    }
    auto& slot = denied ? question_.instead : question_.happening;
    const bool is_known = slot && slot->action == found.front().action && slot->feature == found.front().feature;
    if (slot && !is_known) {
      fail(place, "E1106", "one thing at a time: '" + phrase(words) + "' is one too many",
           "ask about it in a question of its own");
    }
    slot = found.front();
    slot->place = place;
  }

  [[nodiscard]] bool says_only_contact(const Words& words) const {
    const bool moves = reader_.sees(one_of(kAvoid));  // "step around"
    return std::all_of(words.begin(), words.end(), [&](const Token& word) {
      return reader_.lexicon().says_only_contact(word.text) || (moves && is_contact(stem(word.text)));
    });
  }

  // --- conditions ---------------------------------------------------------------
  void conditions(bool present) {
    do {
      one_condition(present);
    } while (takes(kAnd));
  }

  // "there is no charger", "the charger is gone", "we remove the charger".
  void one_condition(bool present) {
    Words words;
    std::optional<Cell> cell;
    for (;;) {
      if (takes(kNot, kGone)) {
        present = !present;
      } else if (const auto name = reader_.take_name()) {
        if (!reader_.lexicon().says_only_contact(name->text)) words.push_back(*name);
      } else if (!words.empty() && !cell && (cell = reader_.take_cell())) {
        continue;
      } else if (!takes(kThere)) {
        break;
      }
    }
    if (words.empty() && !reader_.is_done() && reader_.lexicon().optional_things().empty())
      fail_as_not_optional(reader_.tokens()[reader_.next()].place, reader_.tokens()[reader_.next()].text);
    if (words.empty()) missing("what if what?");
    question_.conditions.push_back({present, thing_of(words), cell, place_of(words)});
  }

  [[nodiscard]] std::string thing_of(const Words& words) const {
    const auto& lexicon = reader_.lexicon();
    const auto named = lexicon.optional_thing(words.front().text);
    for (const auto& word : words) {
      if (lexicon.optional_thing(word.text) != named)
        fail(word.place, "E1106", "two things in one: '" + phrase(words) + "'", "put 'and' between them");
    }
    if (named) return *named;
    fail_as_not_optional(place_of(words), phrase(words));
  }

  [[noreturn]] void fail_as_not_optional(const Place& place, const std::string& what) const {
    const auto things = reader_.lexicon().optional_things();
    const auto nearest = nearest_word(what, things);
    fail(place, "E1108", "'" + what + "' is not optional in this domain",
         !nearest.empty()          ? "did you mean '" + nearest + "'?"
         : !reader_.domain().map() ? "without a map, worlds differ as a whole: ask 'in world N'"
         : things.empty()          ? "all its worlds are the same"
                                   : "optional in this domain: " + listed(things));
  }

  // Where a question begins behind its condition: ", does it recharge", "what would it do".
  [[nodiscard]] std::size_t where_it_goes_on() const {
    const auto& tokens = reader_.tokens();
    for (auto i = reader_.at() + 1; i < tokens.size(); ++i) {
      const auto next = i + 1 < tokens.size() ? tokens[i + 1].text : "";
      const bool is_asked = tokens[i - 1].kind == Token::Kind::kComma || next == "it";
      if (means(tokens[i].meanings, kWhat) || (means(tokens[i].meanings, kAux) && is_asked)) return i;
    }
    return tokens.size();
  }

  // "when the lift is broken", of a world that is called so.
  [[nodiscard]] bool is_a_world() const {
    const auto& tokens = reader_.tokens();
    return reader_.is_done() && std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(reader_.at()), tokens.end(),
                                            [](const Token& token) { return token.kind == Token::Kind::kWorld; });
  }

  // --- what a question turns out to be ------------------------------------------
  void settle() {
    auto& kind = question_.kind;
    const bool says_where = question_.is_about_a_step();
    const bool names_nothing = !question_.happening && !question_.instead;
    const bool is_feature = question_.happening && !question_.happening->action && !question_.instead;
    if (kind == Kind::kWhy && values_ && is_feature && !says_where) kind = Kind::kHowMuch;  // "why does it mind rubble"
    if (kind == Kind::kWhere && names_nothing && says_where) kind = Kind::kWhat;  // "where does it go from (2,3)"
    const auto& actions = reader_.domain().action_names();
    if (question_.carried && !says_where && names_nothing && std::ranges::count(actions, "pickup") > 0) {
      question_.happening = reader_.lexicon().happenings({"pickup"}).front();  // "does it carry the parcel"
      question_.carried.reset();
    }
  }

  void check() {
    settle();
    const bool asks_worlds = question_.kind == Kind::kWhen || question_.kind == Kind::kWhere;
    if (asks_worlds && question_.happening && question_.instead) {
      fail(question_.instead->place, "E1106", "'when' and 'where' take one thing that happens, or does not",
           "ask about the other one in a question of its own");
    }
    // "When does it not recharge?" asks for the worlds in which it does not.
    if (asks_worlds && !question_.happening) {
      std::swap(question_.happening, question_.instead);
      question_.negated = question_.happening.has_value();
    }
    const bool says_where = question_.is_about_a_step();
    const bool names_nothing = !question_.happening && !question_.instead;
    if (question_.kind == Kind::kWhen && names_nothing) missing("when does what happen?");
    if (question_.kind == Kind::kWhere && names_nothing) missing("where does what happen?");
    if (question_.kind == Kind::kWhy && names_nothing && !says_where) missing("why what?");
    const bool is_about_a_path = counts_ || question_.world || reader_.domain().num_mdps() == 1;
    if (question_.kind == Kind::kWhat && !says_where && !is_about_a_path) missing("what does it do where?");
    if (question_.carried && !says_where) missing("carrying it where? Name a cell");
    if (asks_worlds && !question_.conditions.empty() && question_.world) {
      fail(question_.conditions.front().place, "E1106", "a world has what it has, and takes no 'if'",
           "ask 'what if' in that world, or leave it out");
    }
    if (question_.kind == Kind::kHowMuch) check_how_much();
    if (question_.said && (says_where || question_.world || question_.carried))
      fail(reader_.whole(), "E1106", "what things are worth is the same everywhere", "leave out place and world");
  }

  void check_how_much() const {
    if (!question_.happening || question_.happening->action) {
      fail(question_.happening ? question_.happening->place : reader_.whole(), "E1106",
           "how much does which feature count?", "its features are " + listed(reader_.domain().feature_names()));
    }
    if (question_.is_about_a_step() || question_.world) {
      fail(reader_.whole(), "E1106", "'how much' takes only a feature: its weight is the same everywhere",
           "for instance: how much " + reader_.lexicon().name_of(*question_.happening));
    }
  }

  [[noreturn]] void missing(const std::string& what) const {
    reader_.refuse_what_is_left();
    fail(reader_.whole(), "E1106", what, Reader::kForms);
  }

  // "what" takes no action or feature; "what does it drive" says nothing with the verb.
  void refuse_name(const Token& name) const {
    if (reader_.lexicon().says_only_contact(name.text)) return;
    fail(name.place, "E1106", "'what' asks for the next step and takes only a cell, an item and a world",
         "ask 'when' or 'why' about '" + name.text + "'");
  }

  [[noreturn]] void fail_to_begin() const {
    const auto& tokens = reader_.tokens();
    if (reader_.is_done()) fail(reader_.whole(), "E1102", "the question is empty", Reader::kForms);
    const auto& first = tokens[reader_.next()];
    const auto nearest = nearest_word(first.text, {"when", "where", "why", "what", "how", "does", "would"});
    fail(first.place, "E1102", "a question begins with when, where, why, what, how much, does or would",
         nearest.empty() ? Reader::kForms : "did you mean '" + nearest + "'?");
  }

  [[noreturn]] void fail(const Place& place, const std::string& id, const std::string& message,
                         const Advice& advice) const {
    reader_.fail_at(place, id, message, advice);
  }

  // --- words ----------------------------------------------------------------------
  template <typename... Some>
  bool takes(Some... some) {
    return reader_.takes(one_of(some...));
  }
  [[nodiscard]] bool says_value() const {
    const auto& tokens = reader_.tokens();
    return std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(reader_.at()), tokens.end(),
                       [](const Token& token) { return (token.meanings & kValues) != 0; });
  }

  Reader reader_;
  Question question_;
  bool prefers_ = false;  // "prefers left to up"
  bool values_ = false;   // "why" speaks of what something is worth
  bool counts_ = false;   // "how many steps does it take"
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
