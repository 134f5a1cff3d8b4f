#include "lexicon.hpp"

#include <algorithm>
#include <cctype>

#include "question_words.hpp"

namespace kith::detail {
namespace {

std::vector<std::string> plain_words(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// Words of a name that say nothing by themselves.
bool adds_nothing(const std::string& word) {
  using enum Meaning;
  return (meanings_of(word) & one_of(kFiller, kAux, kWhen, kWhere, kWhy, kWhat, kWhich, kWhether, kIf, kOr, kTo)) != 0;
}

}  // namespace

Lexicon::Lexicon(const Domain& domain) : domain_{domain} {
  const auto d = domain.num_features();
  for (std::size_t a = 0; a < domain.action_names().size(); ++a) {
    const auto& name = domain.action_names()[a];
    meanings_[stem(name)].insert(d + a);
    words_.push_back(name);
  }
  for (std::size_t k = 0; k < d; ++k) {
    meanings_[stem(domain.feature_names()[k])].insert(k);
    words_.push_back(domain.feature_names()[k]);
  }
  for (std::size_t k = 0; k < d; ++k) {
    add_words(domain.wording(k).one, k);
    add_words(domain.wording(k).do_one, k);
    for (const auto* text : {&domain.wording(k).one, &domain.wording(k).do_one}) {
      const auto words = plain_words(*text);
      const bool is_verb = text != &domain.wording(k).one || (!words.empty() && words.front().ends_with("ing"));
      if (!words.empty() && is_verb && stem(domain.feature_names()[k]) != stem(words.front())) {
        verbs_.insert(stem(words.front()));
      }
    }
  }
  for (std::size_t k = 0; k < d; ++k) add_things(k);
}

// The things that a feature's condition names, and what kind of thing they are, where no other feature has the word.
void Lexicon::add_things(std::size_t feature) {
  for (const auto& thing : domain_.feature_things(feature)) {
    for (const auto& word : thing.kind == "station" ? std::vector{thing.name, thing.kind} : std::vector{thing.name}) {
      if (thing.kind != "item" && meanings_.count(stem(word)) == 0) add_words(word, feature);
    }
  }
}

void Lexicon::add_words(const std::string& text, std::size_t feature) {
  for (const auto& word : plain_words(text)) {
    if (adds_nothing(word)) continue;
    // An action's name stays the action's, also where the words about a feature use it.
    auto& meanings = meanings_[stem(word)];
    const bool names_action =
        std::any_of(meanings.begin(), meanings.end(), [&](std::size_t m) { return m >= domain_.num_features(); });
    if (!names_action) meanings.insert(feature);
    if (std::find(words_.begin(), words_.end(), word) == words_.end()) words_.push_back(word);
  }
}

bool Lexicon::is_item(const std::string& stem_of_word) const {
  const auto map = domain_.map();
  if (!map) return false;
  const auto& items = map->item_names();
  return std::any_of(items.begin(), items.end(), [&](const auto& item) { return stem(item) == stem_of_word; });
}

bool Lexicon::is_only_item(const std::string& word) const {
  return is_item(stem(word)) && meanings_.count(known_stem(word)) == 0;
}

bool Lexicon::has_action(const std::string& name) const {
  const auto& names = domain_.action_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string Lexicon::known_stem(const std::string& word) const {
  const auto own = stem(word);
  if (meanings_.count(own) != 0) return own;
  for (const auto& row : synonyms()) {
    if (std::none_of(row.begin(), row.end(), [&](const auto& other) { return stem(other) == own; })) continue;
    for (const auto& other : row) {
      if (meanings_.count(stem(other)) != 0) return stem(other);
    }
  }
  return own;
}

bool Lexicon::is_weak(const std::string& stem_of_word) const {
  return verbs_.count(stem_of_word) != 0 || is_contact(stem_of_word);
}

bool Lexicon::knows(const std::string& word) const {
  // "drop off" is two words for one action.
  if (stem(word) == "off" && has_action("dropoff")) return true;
  return is_item(stem(word)) || meanings_.count(known_stem(word)) != 0 || is_contact(stem(word));
}

bool Lexicon::names_something(const std::string& word) const {
  const auto own = known_stem(word);
  const auto& names = domain_.feature_names();
  const bool is_name = std::any_of(names.begin(), names.end(), [&](const auto& name) { return stem(name) == own; });
  return meanings_.count(own) != 0 && (is_name || !is_weak(stem(word)));
}

std::set<std::size_t> Lexicon::common_meanings(const std::vector<std::string>& stems) const {
  const auto meanings_of = [&](const std::string& word) {
    const auto found = meanings_.find(word);
    return found == meanings_.end() ? std::set<std::size_t>{} : found->second;
  };
  std::optional<std::set<std::size_t>> common;
  for (const auto& word : stems) {
    if (is_weak(word)) continue;
    const auto meanings = meanings_of(word);
    if (!common) common = meanings;
    std::erase_if(*common, [&](std::size_t m) { return meanings.count(m) == 0; });
  }
  for (const auto& word : stems) {
    if (!is_weak(word)) continue;
    const auto meanings = meanings_of(word);
    auto narrowed = common ? *common : meanings;
    std::erase_if(narrowed, [&](std::size_t m) { return meanings.count(m) == 0; });
    if (!narrowed.empty()) common = narrowed;
  }
  return common.value_or(std::set<std::size_t>{});
}

std::vector<Happening> Lexicon::happenings(const std::vector<std::string>& words) const {
  std::vector<std::string> stems;
  stems.reserve(words.size());
  for (const auto& word : words) stems.push_back(known_stem(word));
  // "pick up the parcel", "put it down", "drop the parcel off": what is carried is clear without saying.
  const auto is_said = [&](const char* action) {
    return has_action(action) && std::find(stems.begin(), stems.end(), stem(action)) != stems.end();
  };
  const bool leaves = is_said("dropoff");
  const bool is_item_alone = std::all_of(stems.begin(), stems.end(),
                                         [&](const auto& word) { return is_item(word) && meanings_.count(word) == 0; });
  if (is_item_alone && has_action("pickup")) stems.insert(stems.begin(), stem("pickup"));  // "take the parcel"
  const bool takes = !leaves && is_said("pickup");
  if (takes || leaves) {
    const auto says_nothing = [&](const std::string& word) {
      return is_item(word) || (takes && word == "up") || (leaves && (word == "off" || word == "down"));
    };
    stems.erase(std::remove_if(stems.begin(), stems.end(), says_nothing), stems.end());
  }

  auto common = common_meanings(stems);
  std::vector<Happening> result;
  const auto d = domain_.num_features();
  const auto is_named = [&](std::size_t m) { return m < d && stem(domain_.feature_names()[m]) == stems.front(); };
  const auto named = std::find_if(common.begin(), common.end(), is_named);
  if (stems.size() == 1 && named != common.end()) common = std::set<std::size_t>{*named};
  for (const auto m : common) {
    Happening happening;
    if (m >= d) happening.action = ActionIndex{m - d};
    if (m < d) happening.feature = m;
    result.push_back(happening);
  }
  return result;
}

bool Lexicon::says_only_contact(const std::string& word) const {
  return is_contact(stem(word)) && meanings_.count(known_stem(word)) == 0;
}

std::string Lexicon::name_of(const Happening& happening) const {
  return happening.action ? domain_.action_names()[happening.action->value()]
                          : domain_.feature_names()[happening.feature];
}

std::vector<std::string> Lexicon::happening_names() const {
  auto names = domain_.action_names();
  names.insert(names.end(), domain_.feature_names().begin(), domain_.feature_names().end());
  return names;
}

std::vector<std::string> Lexicon::all_words() const {
  auto words = words_;
  const auto add = [&](const std::vector<std::string>& more) { words.insert(words.end(), more.begin(), more.end()); };
  add(optional_things());
  if (const auto map = domain_.map()) add(map->item_names());
  return words;
}

std::optional<std::string> Lexicon::optional_thing(const std::string& word) const {
  const auto things = optional_things();
  for (const auto& thing : things) {
    if (stem(thing) == stem(word)) return thing;
  }
  // By a feature that it brings: "what if it cannot recharge?".
  const auto found = meanings_.find(known_stem(word));
  if (found == meanings_.end() || found->second.size() != 1 || *found->second.begin() >= domain_.num_features()) {
    return std::nullopt;
  }
  for (const auto& named : domain_.feature_things(*found->second.begin())) {
    if (std::find(things.begin(), things.end(), named.name) != things.end()) return named.name;
  }
  return std::nullopt;
}

std::vector<std::string> Lexicon::optional_things() const {
  std::vector<std::string> things;
  for (const auto& group : domain_.optional_groups()) {
    if (std::find(things.begin(), things.end(), group.name) == things.end()) things.push_back(group.name);
  }
  return things;
}

}  // namespace kith::detail
