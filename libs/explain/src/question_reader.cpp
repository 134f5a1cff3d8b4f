#include "question_reader.hpp"

#include <algorithm>
#include <set>

#include "kith/core/text.hpp"

namespace kith::detail {
namespace {

using TokenKind = Token::Kind;
using enum Meaning;

bool is_structure(const Token& token) {
  return (token.meanings & one_of(kNot, kThan, kInstead, kAnd, kWith, kBut)) != 0;
}

// The names of the states that are meant, each once.
template <typename Predicate>
std::vector<std::string> names_of_states(const Domain& domain, const Predicate& is_meant) {
  std::set<std::string> names;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    for (StateIndex s{0}; s.value() < domain.mdp(m).num_states(); ++s) {
      if (is_meant(m, s)) names.insert(domain.state_name(m, s));
    }
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> all_states(const Domain& domain) {
  return names_of_states(domain, [](MdpIndex, StateIndex) { return true; });
}

// What the model's files call so.
std::vector<std::string> states_with_key(const Domain& domain, const std::string& key) {
  return names_of_states(domain, [&](MdpIndex m, StateIndex s) { return domain.state_key(m, s) == key; });
}

// What the picture of a model shows in a cell.
std::vector<std::string> states_drawn_at(const Domain& domain, std::size_t column, std::size_t row) {
  const auto picture = domain.drawing();
  return names_of_states(domain, [&](MdpIndex m, StateIndex s) {
    return picture && picture->state(m, s).robot.x == static_cast<int>(column) &&
           picture->state(m, s).robot.y == picture->height() + 1 - static_cast<int>(row);
  });
}

Advice hint_of_states(const std::string& name, const std::vector<std::string>& names) {
  constexpr std::size_t kListed = 8;
  constexpr std::size_t kMostCompared = 5'000;  // comparing with more takes too long
  const auto nearest = names.size() > kMostCompared ? "" : nearest_word(name, names);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  return names.size() > kListed ? Advice{Remedy::kShowStates} : Advice{"its states are " + listed(names)};
}

}  // namespace

Reader::Reader(const Domain& domain, const std::string& text)
    : domain_{domain}, map_{domain.map()}, text_{text}, lexicon_{domain} {
  auto tokens = with_phrases(with_worlds(tokens_of(text)));
  for (auto& token : tokens) {
    const bool is_in_name = means(token.meanings, kWith) && lexicon_.knows(token.text);  // "a move with the skateboard"
    if (is_in_name) token.meanings |= one_of(kFiller);
    if (token.kind != TokenKind::kWord || is_structure(token) || !lexicon_.knows(token.text)) continue;
    token.kind = TokenKind::kName;
    token.meanings = 0;
  }
  for (std::size_t i = 0; i < tokens.size();) {
    if (is_way_of_speaking(tokens, i))
      tokens[i] = {TokenKind::kWord, tokens[i].text, 0, 0, tokens[i].place, one_of(kFiller)};
    const auto n = read_context(tokens, i);
    tokens_.push_back(tokens[i]);
    i += std::max<std::size_t>(n, 1);
  }
  end_ = tokens_.size();
}

// Names of worlds as one token each: in quotes, behind words such as "in", "during" or "world", or anywhere if the name
// has several words; "lift broken" is also said as "lift is broken".
std::vector<Token> Reader::with_worlds(std::vector<Token> tokens) const {
  std::vector<std::vector<std::string>> names;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) names.push_back(texts_of(tokens_of(domain_.world_name(m))));
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    auto before = i;
    while (before > 0 && tokens[before - 1].text == "the") --before;
    const bool is_introduced = before > 0 && means(meanings_of(tokens[before - 1].text), kIn);
    std::size_t world = 0, length = 0;
    if (tokens[i].kind == TokenKind::kQuoted) {
      const auto found = domain_.find_world(tokens[i].text);
      const bool is_said = i > 0 && tokens[i - 1].text == "world";
      if (!found || (!is_said && !map_ && std::ranges::count(all_states(domain_), tokens[i].text) > 0)) continue;
      world = found->value();
      length = 1;
    }
    for (std::size_t m = 0; m < names.size() && tokens[i].kind != TokenKind::kQuoted; ++m) {
      auto at = i;
      for (const auto& word : names[m]) {
        while (at > i && at < tokens.size() && tokens[at].text != word && means(meanings_of(tokens[at].text), kAux))
          ++at;
        const bool fits = at < tokens.size() && tokens[at].kind != TokenKind::kQuoted && tokens[at].text == word;
        at = fits ? at + 1 : tokens.size() + 1;
      }
      const auto n = names[m].size();
      if (n == 0 || at > tokens.size() || (n == 1 && (!is_introduced || tokens[i].kind == TokenKind::kNumber)) ||
          n <= length)
        continue;
      world = m;
      length = at - i;
    }
    if (length == 0) continue;
    const auto place = place_of({tokens[i], tokens[i + length - 1]});
    tokens[i] = {TokenKind::kWorld, tokens[i].text, world, 0, place};
    const auto next = tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    tokens.erase(next, next + static_cast<std::ptrdiff_t>(length) - 1);
  }
  return tokens;
}

// "go up the stairs": no action.
bool Reader::is_way_of_speaking(const std::vector<Token>& tokens, std::size_t i) const {
  if (tokens[i].text != "up" && tokens[i].text != "down") return false;
  const auto before = i > 0 ? stem(tokens[i - 1].text) : std::string{};
  auto next = i + 1;
  while (next < tokens.size() && (tokens[next].text == "the" || tokens[next].text == "a")) ++next;
  return next > i + 1 && next < tokens.size() && before != "pick" && before != "put" &&
         lexicon_.names_something(tokens[next].text);
}

std::size_t Reader::read_context(std::vector<Token>& tokens, std::size_t i) const {
  auto& token = tokens[i];
  const auto is_number = [&](std::size_t at) { return at < tokens.size() && tokens[at].kind == TokenKind::kNumber; };
  if (token.text == "world" || token.text == "mdp" || token.text == "the world") return read_world(tokens, i);
  if (token.kind == TokenKind::kQuoted) return name_state(token), 1;
  if (token.kind == TokenKind::kCell) return place_cell(token), 1;
  if (means(token.meanings, kState) && !map_) return read_state(tokens, i);
  const bool may_be_state = is_number(i) && i > 0 && means(tokens[i - 1].meanings, kAt) && !map_;
  if (may_be_state && !states_with_key(domain_, token.text).empty()) return name_state(token), 1;
  const auto row = i + 2 + (i + 2 < tokens.size() && tokens[i + 2].kind == TokenKind::kComma ? 1 : 0);
  const bool has_row = is_number(i + 1) && is_number(row + 1) && means(tokens[row].meanings, kRow);
  if (means(token.meanings, kColumn) && domain_.drawing() && has_row) {
    const auto& last = tokens[row + 1].place;
    token = {TokenKind::kCell, token.text, tokens[i + 1].number, tokens[row + 1].number, token.place};
    token.place.length = last.column + last.length - token.place.column;
    return place_cell(token), row + 2 - i;
  }
  if ((token.meanings & one_of(kCarry, kWith)) != 0) return read_item(tokens, i);
  return 0;
}

std::size_t Reader::read_world(std::vector<Token>& tokens, std::size_t i) const {
  const auto numbers = "0 to " + std::to_string(domain_.num_mdps() - 1);
  if (i + 1 < tokens.size() && tokens[i + 1].kind == TokenKind::kNumber) {
    const auto number = tokens[i + 1];
    if (number.number >= domain_.num_mdps())
      fail_at(number.place, "E1105", "there is no world " + number.text, "they are numbered " + numbers);
    tokens[i] = number;
    tokens[i].kind = TokenKind::kWorld;
    return 2;
  }
  const auto is_world = [](const Token& token) { return token.kind == TokenKind::kWorld; };
  const bool is_named = i + 1 < tokens.size() && is_world(tokens[i + 1]);
  if (is_named || tokens[i].text == "the world" || std::any_of(tokens_.begin(), tokens_.end(), is_world)) {
    tokens[i].meanings = one_of(kFiller);
    return 1;
  }
  std::vector<std::string> names;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    if (const auto name = domain_.world_name(m); !name.empty()) names.push_back("'" + name + "'");
  }
  constexpr std::size_t kFew = 8;
  fail_at(tokens[i].place, "E1105", "which world?",
          names.empty() || names.size() > kFew ? "write its number, " + numbers
                                               : "write its number, " + numbers + ", or its name: " + listed(names));
}

// "state 0", "state on the bank at a1": the longest stretch of words that is a name, or the next word.
std::size_t Reader::read_state(std::vector<Token>& tokens, std::size_t i) const {
  if (i + 1 == tokens.size())
    fail_at(tokens[i].place, "E1104", "which state?", Advice{"write its name", Remedy::kShowStates});
  tokens[i].meanings = one_of(kFiller);
  if (tokens[i + 1].kind == TokenKind::kQuoted) return 1;
  const auto names = all_states(domain_);
  const auto is_name = [&](const std::string& name) { return std::ranges::count(names, name) > 0; };
  const auto begin = tokens[i + 1].place.column - 1;
  for (auto last = tokens.size() - 1;; --last) {
    const auto end = tokens[last].place.column - 1 + tokens[last].place.length;
    auto name = text_.substr(begin, end - begin);
    const bool is_whole = is_name(name) || is_name("state " + name);
    if (!is_whole && last > i + 1) continue;
    if (is_whole && !is_name(name)) name.insert(0, "state ");
    tokens[i] = {TokenKind::kState, name, 0, 0, {begin + 1, end - begin}};
    name_state(tokens[i]);
    return last + 1 - i;
  }
}

std::size_t Reader::read_item(std::vector<Token>& tokens, std::size_t i) const {
  auto at = i + 1;
  while (at < tokens.size() && means(tokens[at].meanings, kFiller)) ++at;
  const auto names = map_ ? map_->item_names() : std::vector<std::string>{};
  for (std::size_t k = 0; k < names.size() && at < tokens.size(); ++k) {
    const bool is_it = stem(names[k]) == stem(tokens[at].text);
    if (!is_it || !(lexicon_.is_only_item(tokens[at].text) || tokens[i].text == "carrying")) continue;
    tokens[i] = {TokenKind::kItem, names[k], k, 0, tokens[at].place};
    return at + 1 - i;
  }
  if (tokens[i].text != "carrying") return 0;
  fail_at(at < tokens.size() ? tokens[at].place : tokens[i].place, "E1103", "carrying what?",
          names.empty() ? "there is nothing to carry in this domain" : "it can carry " + listed(names));
}

// Of the name of a state, or of a part of it that no other has, or of what the model's files call it.
void Reader::name_state(Token& token) const {
  token.kind = TokenKind::kState;
  if (map_) {
    fail_at(token.place, "E1104", "states have no names in a domain with a map",
            "name a cell: (COLUMN,ROW), or an action or a feature without quotes");
  }
  const auto names = all_states(domain_);
  if (std::ranges::count(names, token.text) > 0) return;
  if (const auto keyed = states_with_key(domain_, token.text); !keyed.empty()) {
    token.text = keyed.front();
    return;
  }
  std::vector<std::string> found;
  for (const auto& name : names) {
    if (name.find(token.text) != std::string::npos) found.push_back(name);
  }
  if (found.size() != 1) {
    fail_at(token.place, "E1104",
            found.empty() ? "there is no state '" + token.text + "' in which the robot has a choice"
                          : "'" + token.text + "' could be " + std::to_string(found.size()) + " states",
            hint_of_states(token.text, found.empty() ? names : found));
  }
  token.text = found.front();
}

// Of a cell of the map, or of a picture, where it is a state.
void Reader::place_cell(Token& token) const {
  const auto cell = "(" + std::to_string(token.number) + "," + std::to_string(token.row) + ")";
  if (!map_) {
    const auto names = states_drawn_at(domain_, token.number, token.row);
    if (names.size() != 1) {
      fail_at(token.place, "E1104",
              !domain_.drawing() ? "this domain has no map, so there are no cells"
              : names.empty()    ? "no state is drawn at " + cell
                                 : std::to_string(names.size()) + " states are drawn at " + cell,
              names.empty() ? Advice{"name a state, in quotes", Remedy::kShowStates} : hint_of_states("", names));
    }
    token.kind = TokenKind::kState;
    token.text = names.front();
    return;
  }
  const auto is_in = [](std::size_t i, int size) { return i >= 1 && i <= static_cast<std::size_t>(size); };
  if (is_in(token.number, map_->width()) && is_in(token.row, map_->height())) return;
  fail_at(token.place, "E1104", "the map has no cell " + cell,
          "it has " + std::to_string(map_->width()) + " columns and " + std::to_string(map_->height()) +
              " rows, counted from the top left, from 1");
}

bool Reader::passes_over(const Token& token) {
  switch (token.kind) {
    case TokenKind::kWord:
      return (token.meanings & one_of(kFiller, kAux)) != 0;
    case TokenKind::kWorld:
    case TokenKind::kState:
    case TokenKind::kCell:
    case TokenKind::kItem:
    case TokenKind::kComma:
      return true;
    case TokenKind::kName:
    case TokenKind::kNumber:
    case TokenKind::kFraction:
    case TokenKind::kQuoted:
    case TokenKind::kSign:
      return false;
  }
  return false;
}

std::size_t Reader::next() const {
  auto i = at_;
  while (i < end_ && passes_over(tokens_[i])) ++i;
  return i;
}

std::size_t Reader::find(Meanings meanings) const {
  for (auto i = at_; i < end_; ++i) {
    if ((tokens_[i].meanings & meanings) != 0) return i;
    if (!passes_over(tokens_[i])) break;
  }
  return kNowhere;
}

std::optional<Token> Reader::take(Meanings meanings) {
  const auto i = find(meanings);
  if (i == kNowhere) return std::nullopt;
  at_ = i + 1;
  return tokens_[i];
}

std::optional<Token> Reader::take_name(Meanings stops) {
  const auto i = next();
  if (i == end_ || tokens_[i].kind != TokenKind::kName || find(stops) < i) return std::nullopt;
  at_ = i + 1;
  return tokens_[i];
}

std::optional<Token> Reader::take_number() {
  const auto i = next();
  if (i == end_ || (tokens_[i].kind != TokenKind::kNumber && tokens_[i].kind != TokenKind::kFraction))
    return std::nullopt;
  at_ = i + 1;
  return tokens_[i];
}

std::optional<Cell> Reader::take_cell() {
  auto i = at_;
  while (i < end_ && tokens_[i].kind == TokenKind::kWord && passes_over(tokens_[i])) ++i;
  if (i == end_ || tokens_[i].kind != TokenKind::kCell) return std::nullopt;
  tokens_[i].kind = TokenKind::kComma;
  at_ = i + 1;
  return Cell{static_cast<int>(tokens_[i].number), map_->height() + 1 - static_cast<int>(tokens_[i].row)};
}

void Reader::finish(Question& question) const {
  refuse_what_is_left();
  const auto once = [&](bool is_first, const Token& token, const std::string& what) {
    if (!is_first)
      fail_at(token.place, "E1106", "one " + what + " at a time", "ask about the other one in a question of its own");
  };
  for (const auto& token : tokens_) {
    const bool is_cell = token.kind == TokenKind::kCell, is_state = token.kind == TokenKind::kState;
    if (is_cell || is_state) {
      once(!question.is_about_a_step(), token, "place");
      question.spot = token.place;
      if (is_state) question.state = token.text;
      if (is_cell)
        question.cell = Cell{static_cast<int>(token.number), map_->height() + 1 - static_cast<int>(token.row)};
    } else if (token.kind == TokenKind::kWorld) {
      once(!question.world || question.world->value() == token.number, token, "world");
      question.world = MdpIndex{token.number};
    } else if (token.kind == TokenKind::kItem) {
      once(!question.carried || question.carried == token.number, token, "thing to carry");
      question.carried = token.number;
    }
  }
}

void Reader::refuse_what_is_left() const {
  if (next() != end_) refuse(tokens_[next()]);
}

void Reader::refuse(const Token& token) const {
  const auto says = [&](auto... some) { return (token.meanings & one_of(some...)) != 0; };
  const auto word = "'" + token.text + "'";
  if (token.kind == TokenKind::kNumber) {
    fail_at(token.place, "E1103", "it is not clear what the number " + token.text + " stands for",
            "write 'world " + token.text + "'" +
                (map_ ? ", or a cell as (COLUMN,ROW)" : ", or 'state " + token.text + "'"));
  }
  if (token.kind == TokenKind::kName)
    fail_at(token.place, "E1106", "one thing at a time: " + word + " is one too many",
            "ask about it in a question of its own");
  if (says(kBut)) fail_at(token.place, "E1106", word + " could mean the opposite", "ask with 'and' or 'not'");
  if (says(kNot, kAvoid, kInstead))
    fail_at(token.place, "E1106", "it is not clear what " + word + " denies here",
            "put it before what it denies, once");
  if (says(kWhen, kWhere, kWhy, kWhat)) {
    fail_at(token.place, "E1106", "one question at a time: " + word + " begins another one",
            "ask about it in a question of its own");
  }
  if (token.kind == TokenKind::kWord && token.meanings == 0) fail_unknown(token);
  fail_at(token.place, "E1103", "kith does not know what " + word + " says here", kForms);
}

// Names the word that is not known, and the nearest of those that are.
void Reader::fail_unknown(const Token& token) const {
  constexpr std::size_t kNearest = 3;
  auto left = lexicon_.all_words();
  std::string nearest;
  std::size_t n = 0;
  for (auto word = nearest_word(token.text, left); !word.empty() && n < kNearest;
       word = nearest_word(token.text, left)) {
    nearest += (n++ == 0 ? "'" : " or '") + word + "'";
    std::erase(left, word);
  }
  fail_at(token.place, "E1103", "kith does not know the word '" + token.text + "'",
          nearest.empty() ? "it knows " + listed(lexicon_.happening_names()) : "did you mean " + nearest + "?");
}

}  // namespace kith::detail
