#include "question_context.hpp"

#include <algorithm>

#include "kith/explain/words.hpp"
#include "question_words.hpp"

namespace kith::detail {

void ContextReader::take_unquoted_state(const Token& word) {
  if (at_ >= tokens_.size())
    fail_at(word.place, "E1104", "which state?", Advice{"write its name", Remedy::kShowStates});
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

std::set<std::string> ContextReader::state_names() const {
  std::set<std::string> names;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    for (StateIndex s{0}; s.value() < domain_.mdp(m).num_states(); ++s) names.insert(domain_.state_name(m, s));
  }
  return names;
}

// The name of the state that the model's files call this.
std::optional<std::string> ContextReader::state_called(const std::string& key) const {
  if (map_) return std::nullopt;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    for (StateIndex s{0}; s.value() < domain_.mdp(m).num_states(); ++s) {
      if (domain_.state_key(m, s) == key) return domain_.state_name(m, s);
    }
  }
  return std::nullopt;
}

bool ContextReader::is_numbered_state(const Token& token) const {
  static const std::set<std::string> kPlaces{"at", "in", "from", "on", "state", "cell", "square", "field", "number"};
  const bool follows = at_ >= 2 && kPlaces.count(tokens_[at_ - 2].text) != 0;
  return follows && token.kind == Token::Kind::kNumber && state_called(token.text).has_value();
}

std::vector<std::string> ContextReader::drawn_at(std::size_t column, std::size_t row) const {
  const auto picture = domain_.drawing();
  std::set<std::string> names;
  for (MdpIndex m{0}; picture && m.value() < domain_.num_mdps(); ++m) {
    for (StateIndex s{0}; s.value() < domain_.mdp(m).num_states(); ++s) {
      const auto robot = picture->state(m, s).robot;
      const bool is_there =
          robot.x == static_cast<int>(column) && robot.y == picture->height() + 1 - static_cast<int>(row);
      if (is_there) names.insert(domain_.state_name(m, s));
    }
  }
  return {names.begin(), names.end()};
}

void ContextReader::take_state(const Token& token) {
  if (map_) {
    fail_at(token.place, "E1104", "states have no names in a domain with a map",
            "name a cell: (COLUMN,ROW), or an action or a feature without quotes");
  }
  need_first(!question_.is_about_a_step(), token.place, "place");
  const auto names = state_names();
  question_.spot = token.place;
  question_.state = token.text;
  if (names.count(token.text) > 0) return;
  if (const auto keyed = state_called(token.text)) {
    question_.state = *keyed;
    return;
  }
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

Advice ContextReader::hint_of_states(const std::string& name, const std::vector<std::string>& names) {
  constexpr std::size_t kListed = 8;
  constexpr std::size_t kMostCompared = 5'000;  // comparing with more takes too long
  const auto nearest = names.size() > kMostCompared ? "" : nearest_word(name, names);
  if (!nearest.empty()) return "did you mean '" + nearest + "'?";
  if (names.size() > kListed) return Remedy::kShowStates;
  return "its states are " + listed(names);
}

void ContextReader::take_drawn_cell(const Token& token) {
  need_first(!question_.is_about_a_step(), token.place, "place");
  const auto names = drawn_at(token.number, token.row);
  if (names.size() == 1) {
    question_.spot = token.place;
    question_.state = names.front();
    return;
  }
  const auto cell = "(" + std::to_string(token.number) + "," + std::to_string(token.row) + ")";
  fail_at(token.place, "E1104",
          !domain_.drawing() ? "this domain has no map, so there are no cells"
          : names.empty()    ? "no state is drawn at " + cell
                             : std::to_string(names.size()) + " states are drawn at " + cell,
          names.empty() ? Advice{"name a state, in quotes", Remedy::kShowStates} : hint_of_states("", names));
}

void ContextReader::take_cell(const Token& token) {
  if (!map_) return take_drawn_cell(token);
  const Cell cell{static_cast<int>(token.number), map_->height() + 1 - static_cast<int>(token.row)};
  if (token.number < 1 || token.number > static_cast<std::size_t>(map_->width()) || token.row < 1 ||
      token.row > static_cast<std::size_t>(map_->height())) {
    fail_at(token.place, "E1104",
            "the map has no cell (" + std::to_string(token.number) + "," + std::to_string(token.row) + ")",
            "it has " + std::to_string(map_->width()) + " columns and " + std::to_string(map_->height()) +
                " rows, counted from the top left, from 1");
  }
  if (question_.kind == Question::Kind::kWhatIf && !question_.conditions.empty()) {
    need_first(!question_.conditions.back().cell, token.place, "cell for a thing");
    question_.conditions.back().cell = cell;
    return;
  }
  need_first(!question_.is_about_a_step(), token.place, "place");
  question_.cell = cell;
  question_.spot = token.place;
}

void ContextReader::take_world(const Token& token) {
  if (at_ < tokens_.size() && tokens_[at_].kind == Token::Kind::kWorld) return;  // its name follows
  static const std::set<std::string> kAnyOf{"any", "every", "each", "all", "some", "a", "which", "what", "the"};
  if (at_ < tokens_.size() && tokens_[at_].kind == Token::Kind::kNumber) {
    const Token number = tokens_[at_++];
    if (number.number < domain_.num_mdps()) return set_world(MdpIndex{number.number}, number.place);
    fail_at(number.place, "E1105", "there is no world " + number.text,
            "they are numbered 0 to " + std::to_string(domain_.num_mdps() - 1));
  }
  if (question_.world || (at_ >= 2 && kAnyOf.count(tokens_[at_ - 2].text) != 0)) return;
  std::vector<std::string> names;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    if (const auto name = domain_.world_name(m); !name.empty()) names.push_back("'" + name + "'");
  }
  constexpr std::size_t kFew = 8;
  const auto numbers = "0 to " + std::to_string(domain_.num_mdps() - 1);
  fail_at(token.place, "E1105", "which world?",
          names.empty() || names.size() > kFew ? "write its number, " + numbers
                                               : "write its number, " + numbers + ", or its name: " + listed(names));
}

void ContextReader::set_world(MdpIndex world, const Place& place) {
  need_first(!question_.world || question_.world == world, place, "world");
  question_.world = world;
}

void ContextReader::need_first(bool is_first, const Place& place, const std::string& what) const {
  if (!is_first)
    fail_at(place, "E1106", "one " + what + " at a time", "ask about the other one in a question of its own");
}

void ContextReader::take_item(const Token& token) {
  while (at_ < tokens_.size() && is_filler(tokens_[at_].text)) ++at_;
  const auto names = map_ ? map_->item_names() : std::vector<std::string>{};
  if (at_ < tokens_.size()) {
    const auto& word = tokens_[at_].text;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (stem(names[i]) != stem(word)) continue;
      need_first(!question_.carried, tokens_[at_].place, "thing to carry");
      ++at_;
      question_.carried = i;
      return;
    }
  }
  fail_at(at_ < tokens_.size() ? tokens_[at_].place : token.place, "E1103", "carrying what?",
          names.empty() ? "there is nothing to carry in this domain" : "it can carry " + listed(names));
}

bool ContextReader::take_column_and_row(const Token& first) {
  const auto number_at = [&](std::size_t i) { return i < tokens_.size() && tokens_[i].kind == Token::Kind::kNumber; };
  if (!number_at(at_) || at_ + 1 >= tokens_.size() || tokens_[at_ + 1].text != "row" || !number_at(at_ + 2))
    return false;
  Token cell{Token::Kind::kCell, first.text, tokens_[at_].number, tokens_[at_ + 2].number, first.place};
  cell.place.length = tokens_[at_ + 2].place.column + tokens_[at_ + 2].place.length - first.place.column;
  at_ += 3;
  take_cell(cell);
  return true;
}

}  // namespace kith::detail
