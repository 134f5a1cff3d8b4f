#include "kith/explain/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>

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

// One side is of one kind, the other mixed: "crossing rubble costs less than 2 steps plus what stopping at the charger
// is worth", "reaching the far goal is worth more than reaching the near goal plus what a step costs".
std::string compared_with_mixed(const Side& plain, const std::string& than, const Side& mixed) {
  const bool is_cost = plain.gains.empty();
  const auto alike = is_cost ? mixed.only_costs() : mixed.only_gains();
  const auto other = is_cost ? mixed.only_gains() : mixed.only_costs();
  return plain.words() + " " + plain.verb() + " " + than + " " + alike.words() + " plus what " + other.words() + " " +
         other.verb();
}

// "crossing rubble costs more than 2 steps", "4 steps cost more than stopping at the charger is worth".
// @param even  both sides weigh the same to the robot: it says so with "at least as much as".
std::string compared(const Side& more, const Side& less, bool even) {
  if (more.empty()) {
    const auto nothing = even ? "at most nothing" : "less than nothing";
    return less.can_be_said() ? less.words() + " " + less.verb() + " " + nothing : less.amount() + less.is() + nothing;
  }
  if (more.parts_can_be_said() && less.parts_can_be_said()) {
    if (more.mixed() && less.empty()) {  // gains and avoided costs: the gains are better than the costs
      const bool plural = more.only_gains().number() == Number::kPlural;
      return more.only_gains().words() + (plural ? " are " : " is ") +
             (even ? "at least as good as " : "better than ") + more.only_costs().words();
    }
    if (more.mixed() && !less.mixed()) return compared_with_mixed(less, even ? "no more than" : "less than", more);
    if (less.mixed() && !more.mixed())
      return compared_with_mixed(more, even ? "at least as much as" : "more than", less);
  }
  if (!more.can_be_said() || !less.can_be_said()) {
    if (less.empty()) return more.amount() + more.is() + (even ? "at least nothing" : "more than nothing");
    if (even) return more.amount() + more.is() + "no less than " + less.amount();
    return more.amount() + (more.mixed() ? " outweigh " : " outweighs ") + less.amount();
  }
  const auto start = more.words() + " " + more.verb();
  if (less.empty()) return start + (even ? " nothing or more" : " something");
  const bool same_verb = more.costs.empty() == less.costs.empty();
  return start + (even ? " at least as much as " : " more than ") + less.words() + (same_verb ? "" : " " + less.verb());
}

}  // namespace

std::string listed(const std::vector<std::string>& things) {
  std::string text;
  for (std::size_t i = 0; i < things.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == things.size() ? " and " : ", ") + things[i];
  }
  return text;
}

std::string times(const Wording& wording, std::int64_t n) {
  return n == 1 ? wording.one : several(wording.many, n, false);
}

std::string times_more(const Wording& wording, std::int64_t n) {
  return n == 1 ? one_more(wording.one) : several(wording.many, n, true);
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

namespace {

// n * multiple / unit for n >= 0, rounded towards nothing or away from it.
std::int64_t scaled(std::int64_t n, std::int64_t multiple, std::int64_t unit, bool up) {
  const Int128 product = Int128{n} * multiple;
  return static_cast<std::int64_t>((product + (up ? unit - 1 : 0)) / unit);
}

// A sentence of small numbers that follows from a constraint, and how much weaker it is: the share of what both sides
// weigh to the robot.
struct Rounding {
  IntegerVector normal;
  double slack = 0.0;
};

// Numbers in units of `unit` / `multiple`. What stands on the heavier side of the inequality is rounded up and what
// stands on the lighter side down, so that whoever agrees with the robot on what is a cost and what a gain, and with
// the constraint, agrees with the result.
Rounding rounded(const Domain& domain, const IntegerVector& normal, std::int64_t multiple, std::int64_t unit) {
  const auto& robot = domain.weights().unit;
  Rounding result{IntegerVector(normal.size()), 0.0};
  const double scale = static_cast<double>(multiple) / static_cast<double>(unit);
  double gap = 0.0, weight = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    if (normal[k] == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    const bool heavier = is_cost == (normal[k] < 0);
    const auto size = scaled(normal[k] < 0 ? -normal[k] : normal[k], multiple, unit, heavier);
    result.normal[k] = normal[k] < 0 ? -size : size;
    const double own = std::abs(robot[static_cast<Eigen::Index>(k)]);
    const double exact = scale * std::abs(static_cast<double>(normal[k]));
    gap += own * std::abs(static_cast<double>(size) - exact);
    weight += own * exact;
  }
  result.slack = weight > 0.0 ? gap / weight : 0.0;
  return result;
}

}  // namespace

HalfSpace in_small_numbers(const Domain& domain, const HalfSpace& half_space) {
  constexpr std::int64_t kLong = 1000;
  constexpr std::int64_t kMultiples = 4;
  constexpr double kClose = 0.1;
  const auto& normal = half_space.normal();
  std::vector<std::int64_t> sizes;
  for (const auto entry : normal) {
    if (entry != 0) sizes.push_back(entry < 0 ? -entry : entry);
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>{});
  if (sizes.front() <= kLong) return half_space;
  // The coarsest that is close enough, else the closest.
  std::optional<Rounding> best;
  for (std::int64_t multiple = 1; multiple <= kMultiples; ++multiple) {
    for (const auto unit : sizes) {
      auto candidate = rounded(domain, normal, multiple, unit);
      if (best && candidate.slack >= best->slack) continue;
      best = candidate;
      if (best->slack <= kClose) return HalfSpace{best->normal};
    }
  }
  return best ? HalfSpace{best->normal} : half_space;
}

std::string in_words(const Domain& domain, const HalfSpace& half_space) {
  Side more, less;
  Int128 value = 0;
  const auto normal = in_small_numbers(domain, half_space).normal();
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto entry = normal[k];
    if (entry == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    (is_cost == (entry < 0) ? more : less).add(thing(domain.wording(k), std::abs(entry)), is_cost);
    value += Int128{entry} * domain.weights().integer[k];
  }
  return compared(more, less, value == 0);
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

// "35.2 steps", "falling into a hole 0.31 times".
std::string times_on_average(const Wording& wording, const std::string& number) {
  const bool counts = wording.many.find(kNumber) != std::string::npos;
  return with_number(counts ? wording.many : wording.many + " {n} times", number);
}

}  // namespace

std::string on_average_in_words(const Domain& domain, const IntegerVector& difference) {
  constexpr double kNothing = 0.005;
  constexpr double kMany = 10.0;
  std::vector<std::string> saves, gains, costs, forgoes;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const double n = static_cast<double>(difference[k]) / static_cast<double>(domain.count_scale());
    if (std::abs(n) < kNothing) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    auto& side = is_cost ? (n < 0 ? saves : costs) : (n < 0 ? forgoes : gains);
    side.push_back(times_on_average(domain.wording(k), fixed(std::abs(n), std::abs(n) < kMany ? 2 : 1)));
  }
  std::vector<std::string> parts;
  if (!saves.empty()) parts.push_back("saves " + listed(saves));
  if (!gains.empty()) parts.push_back("gains " + listed(gains));
  if (!costs.empty()) parts.push_back("costs " + listed(costs));
  if (!forgoes.empty()) parts.push_back("forgoes " + listed(forgoes));
  return parts.empty() ? "on average its choice makes almost no difference" : "on average its choice " + listed(parts);
}

std::string counts_text(const Domain& domain, const IntegerVector& counts) {
  std::string text;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (counts[k] == 0) continue;
    text += (text.empty() ? "" : ", ") + domain.feature_names()[k] + " " + count_text(counts[k], domain.count_scale());
  }
  return text.empty() ? "nothing" : text;
}

double return_of(const Domain& domain, const IntegerVector& counts) {
  return domain.weights().return_of(counts) / static_cast<double>(domain.count_scale());
}

std::string counted(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string chance_in_words(const Domain& domain, MdpIndex world, const Trajectory& path) {
  const auto& mdp = domain.mdp(world);
  double chance = 1.0;
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto choices = mdp.choices(path.states[t]);
    const auto choice = std::ranges::find(choices, path.actions[t], &Choice::action);
    if (choice == choices.end()) return "";
    double step = 0.0;
    for (const auto& outcome : mdp.outcomes(*choice)) {
      if (outcome.next == path.states[t + 1]) step += outcome.probability;
    }
    chance *= step;
  }
  constexpr double kCertain = 1.0 - 1e-9;
  constexpr double kSmall = 0.01;
  if (chance > kCertain) return "";
  return "likeliest path, chance " + (chance < kSmall ? "below 1" : fixed(100.0 * chance, 0)) + " %";
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

std::string cell_text(const GridMap& map, const Cell& cell) {
  return "(" + std::to_string(cell.x) + "," + std::to_string(map.height() + 1 - cell.y) + ")";
}

std::string action_words(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "goes " + action;
  }
  if (action == "pickup") return "picks it up";
  if (action == "dropoff") return "puts it down";
  if (action == "exit") return "leaves";
  return "does '" + action + "'";
}

std::string action_infinitive(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "go " + action;
  }
  if (action == "pickup") return "pick it up";
  if (action == "dropoff") return "put it down";
  if (action == "exit") return "leave";
  return "do '" + action + "'";
}

}  // namespace kith
