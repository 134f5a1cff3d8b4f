#include "kith/explain/bracket.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kith/explain/statement.hpp"
#include "kith/geometry/cone.hpp"

namespace kith {
namespace {

Ratio in_lowest_terms(std::int64_t numerator, std::int64_t denominator) {
  const auto divisor = std::gcd(numerator, denominator);
  return {numerator / divisor, denominator / divisor};
}

// Exactly, whatever the size of the entries.
bool is_less(const Ratio& a, const Ratio& b) {
  return Int128{a.numerator} * b.denominator < Int128{b.numerator} * a.denominator;
}

// w_k / |w_r| of a cone is between those of its generators; where one has no w_r, there is no end on its side.
Bracket bracket_of(std::size_t k, std::size_t r, std::span<const IntegerVector> generators) {
  Bracket bracket{k, r, {}, {}};
  bool is_open_below = false, is_open_above = false;
  for (const auto& ray : generators) {
    if (ray[r] == 0) {
      is_open_below = is_open_below || ray[k] < 0;
      is_open_above = is_open_above || ray[k] > 0;
      continue;
    }
    const auto ratio = in_lowest_terms(ray[k], std::abs(ray[r]));
    if (!bracket.low || is_less(ratio, *bracket.low)) bracket.low = ratio;
    if (!bracket.high || is_less(*bracket.high, ratio)) bracket.high = ratio;
  }
  if (is_open_below) bracket.low.reset();
  if (is_open_above) bracket.high.reset();
  return bracket;
}

// n / d for d > 0, down or up.
std::int64_t whole(const Ratio& ratio, bool up) {
  const auto n = ratio.numerator / ratio.denominator, rest = ratio.numerator % ratio.denominator;
  return n + (up && rest > 0 ? 1 : 0) - (!up && rest < 0 ? 1 : 0);
}

// The text of `least` and of `most`, empty if there is none; both are 0 or more.
std::pair<std::string, std::string> texts_of(const Domain& domain, const std::optional<Ratio>& least,
                                             const std::optional<Ratio>& most) {
  constexpr double kNear = 0.1;
  if (least && most) {
    const double n = std::nearbyint(least->value());
    if (n >= 1.0 && n - least->value() <= kNear && std::abs(most->value() - n) <= kNear) {
      const auto text = std::to_string(std::llround(n));
      return {text, text};
    }
  }
  const auto text = [&](const std::optional<Ratio>& end, bool up) {
    if (!end) return std::string{};
    const auto n = whole(*end, up);
    return std::to_string(domain.is_exact() ? n : round_number(n, up));
  };
  return {text(least, false), text(most, true)};
}

std::optional<Ratio> times(const std::optional<Ratio>& ratio, std::int64_t sign) {
  return ratio ? std::optional{Ratio{sign * ratio->numerator, ratio->denominator}} : std::nullopt;
}

// "4 steps", "2 to 4 steps".
std::string amount(const Wording& wording, const std::string& number) {
  if (number == "1") return wording.one;
  auto text = wording.many;
  const std::string mark = "{n}";
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + number.size())) {
    text.replace(at, mark.size(), number);
  }
  return text;
}

// What is at least `least` and at most `most`, if there are such; both are 0 or more.
std::string range_in_words(const Domain& domain, std::size_t reference, const std::optional<Ratio>& least,
                           const std::optional<Ratio>& most) {
  const auto& unit = domain.wording(reference);
  const auto [from, to] = texts_of(domain, least, most);
  const bool has_least = least && from != "0";
  if (has_least && from == to) return (*least == *most ? "" : "about ") + amount(unit, from);
  if (has_least && most) return amount(unit, from + " to " + to);
  if (has_least) return "more than " + amount(unit, from);
  if (most && most->numerator == 0) return "nothing";
  return most ? "less than " + amount(unit, to) : "something";
}

bool is_cost(const Bracket& bracket) { return bracket.high && bracket.high->numerator <= 0; }
bool is_gain(const Bracket& bracket) { return bracket.low && bracket.low->numerator >= 0; }

}  // namespace

std::vector<Bracket> brackets(const Domain& domain, std::span<const HalfSpace> known,
                              std::span<const std::size_t> features, std::size_t reference) {
  Cone region{domain.num_features()};
  if (!region.clip(known)) throw std::invalid_argument{"brackets: the region has no interior"};
  const auto generators = region.generators();
  const auto is_on = [&](int sign) {
    return std::ranges::all_of(generators, [&](const IntegerVector& ray) { return sign * ray[reference] >= 0; });
  };
  std::vector<Bracket> all;
  if (!is_on(1) && !is_on(-1)) return all;
  for (const auto k : features) {
    auto bracket = bracket_of(k, reference, generators);
    if (bracket.low || bracket.high) all.push_back(bracket);
  }
  return all;
}

Bracket while_others_stay(const Domain& domain, std::span<const HalfSpace> known, std::size_t k,
                          std::size_t reference) {
  const auto& weights = domain.weights().integer;
  Bracket bracket{k, reference, {}, {}};
  for (const auto& half_space : known) {
    const auto& normal = half_space.normal();
    if (normal[k] == 0) continue;
    Int128 others = 0;
    for (std::size_t j = 0; j < normal.size(); ++j) {
      if (j != k) others += Int128{normal[j]} * weights[j];
    }
    const Int128 denominator = Int128{std::abs(normal[k])} * std::abs(weights[reference]);
    const Int128 numerator = normal[k] > 0 ? -others : others;
    constexpr auto kMost = Int128{std::numeric_limits<std::int64_t>::max()};
    if (numerator > kMost || numerator < -kMost || denominator > kMost || denominator == 0) continue;
    const auto end = in_lowest_terms(static_cast<std::int64_t>(numerator), static_cast<std::int64_t>(denominator));
    auto& known_end = normal[k] > 0 ? bracket.low : bracket.high;
    const bool is_tighter = !known_end || (normal[k] > 0 ? is_less(*known_end, end) : is_less(end, *known_end));
    if (is_tighter) known_end = end;
  }
  return bracket;
}

BracketEnds ends_of(const Domain& domain, const Bracket& bracket) {
  if (is_cost(bracket)) {
    auto [from, to] = texts_of(domain, times(bracket.high, -1), times(bracket.low, -1));
    return {from, to};
  }
  if (is_gain(bracket)) {
    auto [from, to] = texts_of(domain, bracket.low, bracket.high);
    return {from, to};
  }
  return {texts_of(domain, {}, times(bracket.low, -1)).second, texts_of(domain, {}, bracket.high).second};
}

std::string bracket_in_words(const Domain& domain, const Bracket& bracket) {
  const auto& thing = domain.wording(bracket.feature).one;
  const auto& [feature, reference, low, high] = bracket;
  if (is_cost(bracket)) return thing + " costs " + range_in_words(domain, reference, times(high, -1), times(low, -1));
  if (is_gain(bracket)) return thing + " is worth " + range_in_words(domain, reference, low, high);
  std::string text = thing;
  if (low) text += " costs " + range_in_words(domain, reference, {}, times(low, -1));
  if (high) text += std::string{low ? " and" : ""} + " is worth " + range_in_words(domain, reference, {}, high);
  return text;
}

}  // namespace kith
