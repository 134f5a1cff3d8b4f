#include "reward.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace kith::detail {
namespace {

// A stretch of text, [begin, end).
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// The word that begins at or after `from`.
std::optional<Stretch> next_word(const std::string& text, std::size_t from) {
  const auto begin = text.find_first_not_of(' ', from);
  if (begin == std::string::npos) return std::nullopt;
  return Stretch{begin, std::min(text.find(' ', begin), text.size())};
}

bool is_article(std::string_view word) { return word == "a" || word == "an" || word == "one"; }

// Words behind which something else begins: the noun that is counted stands before them.
bool ends_noun(std::string_view word) {
  static constexpr std::array<std::string_view, 27> kWords{
      "on",    "at",     "in",     "of",    "to",      "from",      "with",  "without", "through",
      "over",  "across", "by",     "for",   "into",    "near",      "that",  "and",     "or",
      "along", "around", "behind", "under", "between", "elsewhere", "there", "back",    "away"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

std::string plural(const std::string& noun) {
  const auto ends_with = [&](std::string_view ending) {
    return noun.size() >= ending.size() && noun.compare(noun.size() - ending.size(), ending.size(), ending) == 0;
  };
  for (const char* hissing : {"s", "x", "z", "ch", "sh"}) {
    if (ends_with(hissing)) return noun + "es";
  }
  const bool consonant_before_y = ends_with("y") && noun.size() > 1 &&
                                  std::string_view{"aeiou"}.find(noun[noun.size() - 2]) == std::string_view::npos;
  return consonant_before_y ? noun.substr(0, noun.size() - 1) + "ies" : noun + "s";
}

}  // namespace

std::string several_by_rule(const std::string& once) {
  for (auto word = next_word(once, 0); word; word = next_word(once, word->end)) {
    if (!is_article(once.substr(word->begin, word->end - word->begin))) continue;
    std::optional<Stretch> noun;
    for (auto next = next_word(once, word->end); next; next = next_word(once, next->end)) {
      if (ends_noun(once.substr(next->begin, next->end - next->begin))) break;
      noun = next;
      if (once[next->end - 1] == ',') {
        --noun->end;
        break;
      }
    }
    if (!noun) break;
    return once.substr(0, word->begin) + "{n}" + once.substr(word->end, noun->begin - word->end) +
           plural(once.substr(noun->begin, noun->end - noun->begin)) + once.substr(noun->end);
  }
  return once + " {n} times";
}

Wording completed(Wording wording) {
  if (wording.many.empty()) wording.many = several_by_rule(wording.one);
  if (!wording.do_one.empty() && wording.do_many.empty()) wording.do_many = several_by_rule(wording.do_one);
  return wording;
}

}  // namespace kith::detail
