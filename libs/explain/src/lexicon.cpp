#include "lexicon.hpp"

#include <algorithm>
#include <cctype>

namespace kith::detail {
namespace {

bool ends_with(const std::string& word, const std::string& ending) {
  return word.size() > ending.size() && word.compare(word.size() - ending.size(), ending.size(), ending) == 0;
}

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

}  // namespace

std::string stem(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::size_t kShort = 4;
  const auto drop = [&](std::size_t n) { word.resize(word.size() - n); };
  if (word.size() > kShort && ends_with(word, "ing")) {
    drop(3);
  } else if (word.size() > kShort && ends_with(word, "ed")) {
    drop(2);
  } else if (word.size() > 3 && ends_with(word, "s")) {
    drop(1);
  }
  if (word.size() > 3 && ends_with(word, "e")) drop(1);
  if (word.size() > 3 && word.back() == word[word.size() - 2]) drop(1);
  return word;
}

const std::set<std::string>& filler_words() {
  static const std::set<std::string> kWords{
      "a",       "an",      "the",    "it",     "its",     "he",     "she",    "robot",   "does",    "do",
      "did",     "is",      "are",    "be",     "will",    "would",  "should", "could",   "can",     "may",
      "there",   "then",    "to",     "of",     "in",      "at",     "on",     "from",    "for",     "by",
      "go",      "goes",    "going",  "move",   "moves",   "take",   "takes",  "taking",  "make",    "makes",
      "happen",  "happens", "this",   "that",   "one",     "n",      "times",  "were",    "was",     "if",
      "or",      "tell",    "me",     "show",   "please",  "ever",   "here",   "any",     "some",    "exactly",
      "about",   "start",   "cell",   "choose", "chooses", "use",    "uses",   "using",   "have",    "has",
      "when",    "where",   "why",    "what",   "you",     "i",      "their",  "over",    "through", "across",
      "into",    "onto",    "along",  "toward", "towards", "walk",   "walks",  "drive",   "drives",  "travel",
      "travels", "turn",    "turns",  "head",   "heads",   "rather", "prefer", "prefers", "moving",  "walking",
      "driving", "turning", "worlds", "way",    "many",    "how",    "try",    "tries",   "decide",  "decides"};
  return kWords;
}

namespace {

// Words that people use for each other. Where a domain knows one of a row, it understands the others.
const std::vector<std::vector<std::string>>& synonyms() {
  static const std::vector<std::vector<std::string>> kRows{{"recharge", "charge", "charger", "refuel", "battery"},
                                                           {"up", "north", "upward", "upwards"},
                                                           {"down", "south", "downward", "downwards"},
                                                           {"left", "west", "leftward", "leftwards"},
                                                           {"right", "east", "rightward", "rightwards"},
                                                           {"pickup", "pick", "collect", "grab", "fetch", "load"},
                                                           {"dropoff", "drop", "deliver", "unload", "put", "drop-off"},
                                                           {"exit", "leave", "finish"},
                                                           {"cross", "traverse", "enter"},
                                                           {"wait", "stay", "stop", "pause"}};
  return kRows;
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
  }
}

void Lexicon::add_words(const std::string& text, std::size_t feature) {
  for (const auto& word : plain_words(text)) {
    if (filler_words().count(word) != 0) continue;
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

bool Lexicon::knows(const std::string& word) const {
  // "drop off" is two words for one action.
  if (stem(word) == "off" && has_action("dropoff")) return true;
  return is_item(stem(word)) || meanings_.count(known_stem(word)) != 0;
}

std::vector<Happening> Lexicon::happenings(const std::vector<std::string>& words) const {
  std::vector<std::string> stems;
  stems.reserve(words.size());
  for (const auto& word : words) stems.push_back(known_stem(word));
  // "pick up the parcel", "put it down", "drop the parcel off": what is carried is clear without saying.
  const bool takes = has_action("pickup") && stems.front() == stem("pickup");
  const bool leaves = has_action("dropoff") && stems.front() == stem("dropoff");
  if (takes || leaves) {
    const auto says_nothing = [&](const std::string& word) {
      return is_item(word) || (takes && word == "up") || (leaves && (word == "off" || word == "down"));
    };
    stems.erase(std::remove_if(stems.begin() + 1, stems.end(), says_nothing), stems.end());
  }

  std::optional<std::set<std::size_t>> common;
  for (const auto& word : stems) {
    const auto found = meanings_.find(word);
    const auto meanings = found == meanings_.end() ? std::set<std::size_t>{} : found->second;
    if (!common) {
      common = meanings;
      continue;
    }
    std::erase_if(*common, [&](std::size_t m) { return meanings.count(m) == 0; });
  }
  std::vector<Happening> result;
  if (!common) return result;
  const auto d = domain_.num_features();
  const auto is_named = [&](std::size_t m) { return m < d && stem(domain_.feature_names()[m]) == stems.front(); };
  const auto named = std::find_if(common->begin(), common->end(), is_named);
  if (stems.size() == 1 && named != common->end()) common = std::set<std::size_t>{*named};
  for (const auto m : *common) {
    Happening happening;
    if (m >= d) happening.action = ActionIndex{m - d};
    if (m < d) happening.feature = m;
    result.push_back(happening);
  }
  return result;
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

std::optional<std::string> Lexicon::optional_thing(const std::string& word) const {
  for (const auto& thing : optional_things()) {
    if (stem(thing) == stem(word)) return thing;
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
