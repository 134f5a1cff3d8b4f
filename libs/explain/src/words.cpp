#include "kith/explain/words.hpp"

#include <cctype>
#include <cstdlib>
#include <utility>

namespace kith {
namespace {

std::string listed(const std::vector<std::string>& things) {
  std::string text;
  for (std::size_t i = 0; i < things.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == things.size() ? " and " : ", ") + things[i];
  }
  return text;
}

// "a step" and 2 -> "2 steps"; "crossing rubble" and 2 -> "crossing rubble twice".
std::string times(const std::string& words, std::int64_t n) {
  if (n == 1) return words;
  for (const std::string article : {"a ", "an ", "one "}) {
    if (words.rfind(article, 0) == 0) return std::to_string(n) + " " + words.substr(article.size()) + "s";
  }
  return words + (n == 2 ? " twice" : " " + std::to_string(n) + " times");
}

enum class Number { kSingular, kPlural, kUnknown };

// One thing of the robot's reward, several times: "crossing rubble", "2 steps".
struct Thing {
  std::string words;
  Number number = Number::kUnknown;
};

// "a step", "the charger" and "crossing rubble" are singular, "2 steps" is plural; of other words nobody knows.
Thing thing(const std::string& words, std::int64_t n) {
  Thing result{times(words, n)};
  const auto first = words.substr(0, words.find(' '));
  const bool gerund = first.size() > 4 && first.substr(first.size() - 3) == "ing";
  if (std::isdigit(static_cast<unsigned char>(result.words.front())) != 0) {
    result.number = Number::kPlural;
  } else if (gerund || first == "a" || first == "an" || first == "one" || first == "the") {
    result.number = Number::kSingular;
  }
  return result;
}

// What stands on one side of the inequality: costs and gains of the robot.
struct Side {
  std::vector<Thing> costs, gains;

  void add(Thing what, bool is_cost) { (is_cost ? costs : gains).push_back(std::move(what)); }
  [[nodiscard]] bool empty() const { return costs.empty() && gains.empty(); }
  [[nodiscard]] bool mixed() const { return !costs.empty() && !gains.empty(); }
  [[nodiscard]] const std::vector<Thing>& things() const { return costs.empty() ? gains : costs; }
  [[nodiscard]] std::string words() const {
    std::vector<std::string> words;
    for (const auto& one : things()) words.push_back(one.words);
    return listed(words);
  }
  // What a verb behind words() agrees with. Only for a side that is not mixed.
  [[nodiscard]] Number number() const { return things().size() > 1 ? Number::kPlural : things().front().number; }
  [[nodiscard]] bool can_be_said() const { return empty() || (!mixed() && number() != Number::kUnknown); }
  // "costs" or "is worth".
  [[nodiscard]] std::string verb() const {
    const bool plural = number() == Number::kPlural;
    return costs.empty() ? (plural ? "are worth" : "is worth") : (plural ? "cost" : "costs");
  }
  // "the cost of 2 steps", "the gain of stopping at the charger", or both.
  [[nodiscard]] std::string amount() const {
    std::vector<std::string> parts;
    if (!costs.empty()) parts.push_back("the cost of " + Side{costs, {}}.words());
    if (!gains.empty()) parts.push_back("the gain of " + Side{{}, gains}.words());
    return listed(parts);
  }
  // The verb of amount().
  [[nodiscard]] std::string is() const { return mixed() ? " together are " : " is "; }
};

// "crossing rubble costs more than 2 steps", "4 steps cost more than stopping at the charger is worth".
std::string compared(const Side& more, const Side& less) {
  if (more.empty()) {
    return less.can_be_said() ? less.words() + " " + less.verb() + " less than nothing"
                              : less.amount() + less.is() + "less than nothing";
  }
  if (!more.can_be_said() || !less.can_be_said()) {
    return more.amount() + (less.empty() ? more.is() + "more than nothing"
                                         : (more.mixed() ? " outweigh " : " outweighs ") + less.amount());
  }
  const auto start = more.words() + " " + more.verb();
  if (less.empty()) return start + " something";
  const bool same_verb = more.costs.empty() == less.costs.empty();
  return start + " more than " + less.words() + (same_verb ? "" : " " + less.verb());
}

}  // namespace

std::string in_words(const Domain& domain, const HalfSpace& half_space) {
  Side more, less;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto entry = half_space.normal()[k];
    if (entry == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    (is_cost == (entry < 0) ? more : less).add(thing(domain.feature_words(k), std::abs(entry)), is_cost);
  }
  return compared(more, less);
}

std::string normal_text(const Domain& domain, const HalfSpace& half_space) {
  std::string text = "(";
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    text += (k > 0 ? "," : "") + std::to_string(half_space.normal()[k]);
  }
  return text + ")";
}

std::string described(const Domain& domain, const HalfSpace& half_space) {
  return normal_text(domain, half_space) + ": " + in_words(domain, half_space);
}

std::string counts_text(const Domain& domain, const IntegerVector& counts) {
  std::string text;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (counts[k] == 0) continue;
    text += (text.empty() ? "" : ", ") + domain.feature_names()[k] + " " + std::to_string(counts[k]);
  }
  return text.empty() ? "nothing" : text;
}

std::string counted(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions) {
  std::string text;
  for (std::size_t i = 0; i < actions.size();) {
    std::size_t n = 1;
    while (i + n < actions.size() && actions[i + n] == actions[i]) ++n;
    text += (text.empty() ? "" : ", ") + domain.action_names()[actions[i].value()];
    if (n > 1) text += " x" + std::to_string(n);
    i += n;
  }
  return text;
}

}  // namespace kith
