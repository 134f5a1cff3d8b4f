#include "kith/explain/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "kith/explain/reason.hpp"
#include "side.hpp"

namespace kith {
namespace {

using detail::Number;
using detail::Side;
using detail::thing;

constexpr const char* kNumber = "{n}";

// The text with every {n} replaced.
std::string with_number(std::string text, const std::string& number) {
  constexpr std::size_t kLength = 3;
  for (auto at = text.find(kNumber); at != std::string::npos; at = text.find(kNumber, at + number.size())) {
    text.replace(at, kLength, number);
  }
  return text;
}

void replace_first(std::string& text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
}

// "cross rubble {n} times" and 2 -> "cross rubble twice".
std::string several(std::string many, std::int64_t n, bool more) {
  if (!more && n == 2) replace_first(many, "{n} times", "twice");
  return with_number(many, std::to_string(n) + (more ? " more" : ""));
}

// "take a step" -> "take one more step"; "cross rubble" -> "cross rubble once more".
std::string one_more(const std::string& once) {
  for (const std::string article : {"a", "an", "one"}) {
    if (once.rfind(article + " ", 0) == 0) return "one more" + once.substr(article.size());
    const auto at = once.find(" " + article + " ");
    if (at != std::string::npos) return once.substr(0, at) + " one more" + once.substr(at + 1 + article.size());
  }
  return once + " once more";
}

// " is better than ", as the first side demands.
std::string better_than(const Side& first, bool even) {
  return (first.number() == Number::kPlural ? " are " : " is ") +
         std::string{even ? "at least as good as " : "better than "};
}

// One side is of one kind, the other mixed: "crossing rubble costs less than 2 steps plus what stopping at the charger
// is worth", "reaching the far goal is worth more than reaching the near goal plus what a step costs".
std::string compared_with_mixed(const Side& plain, const std::string& than, const Side& mixed) {
  const bool is_cost = plain.gains.empty();
  const auto alike = is_cost ? mixed.only_costs() : mixed.only_gains();
  const auto other = is_cost ? mixed.only_gains() : mixed.only_costs();
  return plain.words() + " " + plain.verb() + " " + than + " " + alike.words() + " plus what " + other.words() + " " +
         other.verb();
}

// "crossing rubble costs more than 2 steps", "stopping at the charger is worth less than 4 steps".
// @param even  both sides weigh the same to the robot: it says so with "at least as much as".
std::string compared(const Side& more, const Side& less, bool even) {
  if (more.empty()) {
    if (less.mixed() && less.parts_can_be_said()) {  // contradicts the robot twice: costs would be better than gains
      return less.only_costs().words() + better_than(less.only_costs(), even) + less.only_gains().words();
    }
    const auto nothing = even ? "at most nothing" : "less than nothing";
    return less.can_be_said() ? less.words() + " " + less.verb() + " " + nothing : less.amount() + less.is() + nothing;
  }
  if (more.parts_can_be_said() && less.parts_can_be_said()) {
    if (more.mixed() && less.empty()) {  // gains and avoided costs: the gains are better than the costs
      return more.only_gains().words() + better_than(more.only_gains(), even) + more.only_costs().words();
    }
    if (more.mixed() && !less.mixed()) return compared_with_mixed(less, even ? "no more than" : "less than", more);
    if (more.mixed() && less.mixed()) {
      return more.benefits() + " are worth " + (even ? "at least as much as " : "more than ") + less.benefits();
    }
    if (less.mixed() && !more.mixed())
      return compared_with_mixed(more, even ? "at least as much as" : "more than", less);
  }
  if (!more.can_be_said() || !less.can_be_said()) {
    if (less.empty()) return more.amount() + more.is() + (even ? "at least nothing" : "more than nothing");
    if (even) return more.amount() + more.is() + "no less than " + less.amount();
    return more.amount() + (more.mixed() ? " outweigh " : " outweighs ") + less.amount();
  }
  if (less.empty()) {
    const std::string together = more.things().size() > 1 ? " together " : " ";
    return more.words() + together + more.verb() + (even ? " nothing or more" : " something");
  }
  // A gain is measured in costs; of two costs, or two gains, what there is less of in the other.
  const bool is_only_one = more.things().size() == 1 && less.things().size() == 1;
  const bool is_less = more.gains.empty() == less.gains.empty()
                           ? is_only_one && less.things().front().n < more.things().front().n
                           : more.gains.empty();
  const auto& [subject, object] = is_less ? std::tie(less, more) : std::tie(more, less);
  const std::string than =
      even ? (is_less ? " at most as much as " : " at least as much as ") : (is_less ? " less than " : " more than ");
  return subject.words() + " " + subject.verb() + than + object.words();
}

}  // namespace

std::string times(const Wording& wording, std::int64_t n) {
  return n == 1 ? wording.one : several(wording.many, n, false);
}

std::string times_more(const Wording& wording, std::int64_t n) {
  return n == 1 ? one_more(wording.one) : several(wording.many, n, true);
}

std::string times_fewer(const Wording& wording, std::int64_t n) {
  const auto is_counted = wording.many.find("{n} times") == std::string::npos;
  if (is_counted && n != 1 && wording.many.find(kNumber) != std::string::npos) {
    return with_number(wording.many, std::to_string(n) + " fewer");
  }
  auto text = n == 1 ? one_more(wording.one) : std::string{};
  if (text.find("one more ") == std::string::npos || !is_counted) return "not " + times(wording, n);
  replace_first(text, "one more ", "one fewer ");
  return text;
}

std::string doing(const Wording& wording, std::int64_t n, bool more) {
  if (wording.do_one.empty()) return "";
  if (n != 1) return several(wording.do_many, n, more);
  return more ? one_more(wording.do_one) : wording.do_one;
}

std::string in_general(const Wording& wording) {
  auto text = wording.many;
  for (const std::string part : {" {n} times", "{n} ", " {n}"}) {
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  }
  return text;
}

CountedAs counted_as(const Wording& wording) {
  const auto without_start = [](std::string text) {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      const auto word = text.substr(0, text.find(' '));
      const bool is_last = word.size() == text.size();
      const bool is_doing = word.size() > 5 && word.ends_with("ing");
      for (const char* small : {"{n}", "a", "an", "the", "at", "on", "in", "into", "to", "through", "over", "once"}) {
        if (!is_last && (is_doing || word == small)) {
          text.erase(0, word.size() + 1);
          goes_on = true;
          break;
        }
      }
    }
    return text;
  };
  const auto one = without_start(wording.one);
  auto many = without_start(wording.many);
  const auto at = many.find("{n}");
  if (at != std::string::npos) many = wording.many.find("{n} times") == std::string::npos ? in_general(wording) : one;
  return {one, without_start(many)};
}

namespace {

// The sentence of a constraint with short numbers.
std::string sentence_of(const Domain& domain, const IntegerVector& normal) {
  Side more, less;
  Int128 value = 0;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto entry = normal[k];
    if (entry == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    (is_cost == (entry < 0) ? more : less).add(thing(domain.wording(k), std::abs(entry)), is_cost);
    value += Int128{entry} * domain.weights().integer[k];
  }
  return compared(more, less, value == 0);
}

}  // namespace

namespace {

std::string sentence_of(const Domain& domain, const std::optional<ShortStatement>& statement) {
  if (!statement) return "";
  const auto sentence = sentence_of(domain, statement->said.normal());
  if (!statement->condition) return sentence;
  return "if " + sentence_of(domain, statement->condition->normal()) + ", " + sentence;
}

// What people who are taught can keep in mind.
std::string told(const Domain& domain, const std::optional<ShortStatement>& statement) {
  if (!statement || statement->condition) return "";
  const auto& normal = statement->said.normal();
  const auto things = std::count_if(normal.begin(), normal.end(), [](std::int64_t n) { return n != 0; });
  auto sentence = things > static_cast<std::ptrdiff_t>(kMostThings) ? std::string{} : sentence_of(domain, normal);
  return std::count(sentence.begin(), sentence.end(), ' ') < kMostWords ? sentence : "";
}

}  // namespace

std::string told(const Domain& domain, const HalfSpace& half_space, std::span<const HalfSpace> together) {
  return told(domain, short_statement(domain, half_space, together));
}

std::string in_words(const Domain& domain, const HalfSpace& half_space, std::span<const HalfSpace> together) {
  return sentence_of(domain, short_statement(domain, half_space, together));
}

std::vector<std::string> each_in_words(const Domain& domain, std::span<const HalfSpace> half_spaces,
                                       std::span<const HalfSpace> together) {
  std::vector<std::string> sentences;
  for (const auto& statement : short_statements(domain, half_spaces, together)) {
    sentences.push_back(told(domain, statement));
  }
  return sentences;
}

std::vector<std::string> all_in_words(const Domain& domain, std::span<const HalfSpace> half_spaces) {
  std::vector<std::string> sentences;
  for (auto& sentence : each_in_words(domain, half_spaces)) {
    if (sentence.empty() || std::find(sentences.begin(), sentences.end(), sentence) != sentences.end()) continue;
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

std::string normal_text(const Domain& domain, const HalfSpace& half_space) {
  std::string text = "(";
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    text += (k > 0 ? "," : "") + std::to_string(half_space.normal()[k]);
  }
  return text + ")";
}

namespace {

std::string percent_explained(const InferredWeights& inferred) {
  return std::to_string(static_cast<int>(std::floor(100.0 * inferred.share + 1e-9))) + " %";
}

}  // namespace

std::string explained_in_words(const Domain& domain) {
  const auto& inferred = domain.inferred();
  if (!inferred) return "";
  const auto left_out = inferred->left_out;
  return "the weights explain " + percent_explained(*inferred) +
         " of what the robot does, from which they were inferred" +
         (left_out == 0
              ? ""
              : "; " + std::to_string(left_out) + (left_out == 1 ? " start is" : " starts are") + " left out");
}

std::string explained_to_people(const Domain& domain) {
  const auto& inferred = domain.inferred();
  if (!inferred || inferred->share >= 1.0) return "";
  return "What it likes and dislikes explains " + percent_explained(*inferred) +
         " of what it does. Only that is shown here.";
}

std::string described(const Domain& domain, const HalfSpace& half_space) {
  const auto sentence = in_words(domain, half_space);
  return normal_text(domain, half_space) + (sentence.empty() ? "" : ": " + sentence);
}

namespace {

std::string fixed(double value, int digits) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, digits).ptr;
  return {text.data(), end};
}

// A count in units of 1 / scale, with three decimals where it is an expectation.
std::string count_text(std::int64_t count, std::int64_t scale) {
  return scale == 1 ? std::to_string(count) : fixed(static_cast<double>(count) / static_cast<double>(scale), 3);
}

}  // namespace

namespace {

double per_try(const Domain& domain, std::int64_t count) {
  return static_cast<double>(count) / static_cast<double>(domain.count_scale());
}

// To two significant digits.
std::int64_t about(double n) {
  constexpr double kThreeDigits = 99.5;  // rounded
  double unit = 1.0;
  while (std::abs(n) / unit >= kThreeDigits) unit *= 10.0;
  return std::llround(n / unit) * std::llround(unit);
}

// Whether some action brings the feature in less than half of the cases, and most actions do not bring it in half of
// them: an accident, or a lucky chance. A step that is not taken because the robot falls is none.
bool is_by_chance(const Mdp& mdp, std::size_t feature) {
  constexpr double kHalf = 0.5;
  bool has_chance = false;
  std::size_t usual = 0, all = 0;
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    for (const auto& choice : mdp.choices(s)) {
      double chance = 0.0;
      for (const auto& outcome : mdp.outcomes(choice)) {
        if (mdp.features(outcome)[feature] != 0.0) chance += outcome.probability;
      }
      has_chance = has_chance || (chance > 0.0 && chance < kHalf);
      usual += chance >= kHalf ? 1U : 0U;
      ++all;
    }
  }
  return has_chance && 2 * usual < all;
}

}  // namespace

std::string on_average_in_words(const Domain& domain, const IntegerVector& difference) {
  if (domain.mdp(MdpIndex{0}).discount() < 1.0) return kAllInAll;  // the counts are none that anybody sees
  // The weightiest thing for the choice, and against it.
  const auto d = domain.num_features();
  std::optional<std::size_t> best, worst;
  const auto weight = [&](std::size_t k) { return Int128{domain.weights().integer[k]} * difference[k]; };
  for (std::size_t k = 0; k < d; ++k) {
    if (weight(k) > 0 && (!best || weight(k) > weight(*best))) best = k;
    if (weight(k) < 0 && (!worst || weight(k) < weight(*worst))) worst = k;
  }
  for (const int tries : {10, 100}) {
    IntegerVector counts(d);
    for (const auto k : {best, worst}) {
      if (k) counts[*k] = about(tries * per_try(domain, difference[*k]));
    }
    const bool is_all = (!best || counts[*best] != 0) && (!worst || counts[*worst] != 0);
    if (!is_all || !best || sign_of_dot(domain.weights().integer, counts) <= 0) continue;
    IntegerVector both(d);  // a single thing is said to be more of it
    if (!worst) both[*best] = 1 + std::abs(counts[*best]);
    const auto choice = choice_in_words(domain, counts + both, both);
    return choice == kAllInAll ? choice : "in " + std::to_string(tries) + " tries " + choice;
  }
  return kAllInAll;
}

std::vector<std::size_t> risks_of(const Domain& domain, MdpIndex world, const IntegerVector& difference) {
  constexpr double kOften = 0.005;  // once in 100 tries, rounded
  std::vector<std::size_t> risked, avoided;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const bool is_told = std::abs(per_try(domain, difference[k])) >= kOften;
    if (domain.weights().integer[k] >= 0 || !is_told || !is_by_chance(domain.mdp(world), k)) continue;
    (difference[k] > 0 ? risked : avoided).push_back(k);
  }
  return risked.empty() ? avoided : risked;
}

std::string risk_in_words(const Domain& domain, MdpIndex world, const IntegerVector& difference) {
  const auto risks = risks_of(domain, world, difference);
  if (risks.empty()) return "";
  std::vector<std::string> names;
  names.reserve(risks.size());
  for (const auto k : risks) names.push_back(domain.wording(k).one);
  return (difference[risks.front()] > 0 ? "it risks " : "it avoids the risk of ") + listed(names);
}

std::string counts_text(const Domain& domain, const IntegerVector& counts) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (counts[k] != 0) parts.push_back(domain.feature_names()[k] + " " + count_text(counts[k], domain.count_scale()));
  }
  return parts.empty() ? "nothing" : joined(parts);
}

double return_of(const Domain& domain, const IntegerVector& counts) {
  return domain.weights().return_of(counts) / static_cast<double>(domain.count_scale());
}

}  // namespace kith
