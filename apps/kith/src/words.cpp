#include "words.hpp"

#include <cstdlib>

namespace kith::cli {
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

// What stands on one side of the inequality: costs and gains of the robot.
struct Side {
  std::vector<std::string> costs, gains;

  void add(const std::string& what, bool is_cost) { (is_cost ? costs : gains).push_back(what); }
  [[nodiscard]] bool empty() const { return costs.empty() && gains.empty(); }
  [[nodiscard]] bool mixed() const { return !costs.empty() && !gains.empty(); }
  [[nodiscard]] std::size_t size() const { return costs.size() + gains.size(); }
  // "what 2 steps cost", "what the charger is worth", or both.
  [[nodiscard]] std::string amount() const {
    std::vector<std::string> parts;
    if (!costs.empty()) parts.push_back("the cost of " + listed(costs));
    if (!gains.empty()) parts.push_back("the gain of " + listed(gains));
    return listed(parts);
  }
};

}  // namespace

std::string in_words(const Domain& domain, const HalfSpace& half_space) {
  Side more, less;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto entry = half_space.normal()[k];
    if (entry == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    (is_cost == (entry < 0) ? more : less).add(times(domain.feature_words(k), std::abs(entry)), is_cost);
  }
  if (more.empty())
    return less.costs.empty() ? listed(less.gains) + " gains nothing" : listed(less.costs) + " costs nothing";
  const bool verb_plural =
      more.size() > 1 ||
      std::isdigit(static_cast<unsigned char>((more.costs.empty() ? more.gains : more.costs).front().front())) != 0;
  if (less.empty() && !more.mixed()) {
    return more.gains.empty() ? listed(more.costs) + (verb_plural ? " cost" : " costs") + " something"
                              : listed(more.gains) + (verb_plural ? " are" : " is") + " worth something";
  }
  if (!more.mixed() && less.gains.empty()) {
    return more.gains.empty()
               ? listed(more.costs) + (verb_plural ? " cost" : " costs") + " more than " + listed(less.costs)
               : listed(more.gains) + (verb_plural ? " are" : " is") + " worth more than " + listed(less.costs);
  }
  if (!more.mixed() && less.costs.empty()) {
    return more.gains.empty()
               ? listed(more.costs) + (verb_plural ? " cost" : " costs") + " more than " + listed(less.gains) +
                     " is worth"
               : listed(more.gains) + (verb_plural ? " are" : " is") + " worth more than " + listed(less.gains);
  }
  return more.amount() + " outweigh " + (less.empty() ? "nothing" : less.amount());
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
    text += (text.empty() ? "" : ", ") + std::to_string(counts[k]) + " " + domain.feature_names()[k];
  }
  return text.empty() ? "nothing" : text;
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

}  // namespace kith::cli
