#include "edit.hpp"

#include <algorithm>

namespace kith::fuzzing {
namespace {

// `count` times what stands between items, and a copy of the item, behind it.
std::string repeated(std::string_view item, const std::string& separator, std::size_t count) {
  const bool open = separator.empty() && !item.ends_with('\n');
  std::string copies;
  for (std::size_t i = 0; i < count; ++i) {
    copies += open ? "\n" : separator;
    copies += item;
  }
  return copies;
}

// The item with the separator that goes with it.
Range to_leave_out(const ItemList& list, std::size_t i) {
  if (i + 1 < list.items.size()) return {list.items[i].begin, list.items[i + 1].begin};
  if (i > 0 && !list.separator.empty()) return {list.items[i - 1].end, list.items[i].end};
  return list.items[i];
}

std::string exchanged(std::string_view text, const Range& a, const Range& b) {
  return replaced(text, {{a, std::string{b.of(text)}}, {b, std::string{a.of(text)}}});
}

std::string moved(std::string_view text, const ItemList& list, std::size_t from, std::size_t to) {
  const auto& item = list.items[from];
  const auto begin = list.items[to].begin;
  auto moved_text = std::string{item.of(text)} + list.separator;
  if (list.separator.empty() && !moved_text.ends_with('\n')) moved_text += '\n';
  return replaced(text, {{to_leave_out(list, from), ""}, {{begin, begin}, std::move(moved_text)}});
}

std::string reversed(std::string_view text, const ItemList& list) {
  std::vector<Replacement> replacements;
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const auto& mirrored = list.items[list.items.size() - 1 - i];
    replacements.push_back({list.items[i], std::string{mirrored.of(text)}});
  }
  return replaced(text, std::move(replacements));
}

// The item in place of the first one of that name; nothing if there is none.
std::optional<std::string> with_named(std::string_view text, const Structure& structure, Level level,
                                      std::string_view item) {
  const auto name = [](std::string_view text_of_item) {
    return text_of_item.substr(0, text_of_item.find_first_of("=:\n"));
  };
  for (const auto& list : structure.lists) {
    if (list.level != level) continue;
    for (const auto& ours : list.items) {
      if (name(ours.of(text)) == name(item)) return replaced(text, {{ours, std::string{item}}});
    }
  }
  return std::nullopt;
}

std::string misspelt(std::string word, Dice& dice) {
  if (word.empty()) return "x";
  const auto at = dice.below(word.size());
  switch (dice.below(4)) {
    case 0:
      word.erase(at, 1);
      break;
    case 1:
      word.insert(at, 1, word[at]);
      break;
    case 2:
      std::swap(word[at], word[word.size() - 1 - at]);
      break;
    default:
      word[at] = static_cast<char>('a' + dice.below(26));
  }
  return word;
}

}  // namespace

std::string replaced(std::string_view text, std::vector<Replacement> replacements) {
  std::stable_sort(replacements.begin(), replacements.end(),
                   [](const auto& a, const auto& b) { return a.range.begin < b.range.begin; });
  std::string result;
  std::size_t at = 0;
  for (const auto& [range, now] : replacements) {
    result += text.substr(at, range.begin - at);
    result += now;
    at = range.end;
  }
  return result += text.substr(at);
}

std::optional<std::string> edit_list(std::string_view text, const Structure& structure, Dice& dice) {
  std::vector<const ItemList*> lists;
  for (const auto& list : structure.lists) {
    if (!list.items.empty()) lists.push_back(&list);
  }
  if (lists.empty()) return std::nullopt;
  const auto& list = *dice.pick(lists);
  const auto n = list.items.size();
  const auto i = dice.below(n);
  const auto j = dice.below(n);
  // A name that is there twice keeps the rest from being looked at: that need not be tried often.
  const bool copies = !list.named || dice.one_in(4);
  switch (copies ? dice.below(8) : dice.below(6)) {
    case 0:
    case 1:
      return replaced(text, {{to_leave_out(list, i), ""}});
    case 2:
      if (i != j && i != j + 1 && j != i + 1) return moved(text, list, i, j);
      [[fallthrough]];
    case 3:
    case 4:
      return i == j ? reversed(text, list) : exchanged(text, list.items[i], list.items[j]);
    case 5:
      return replaced(text, {{{list.items[i].begin, list.items[std::max(i, j)].end}, ""}});
    case 6: {
      const auto count = dice.one_in(8) ? 2 + dice.below(30) : 1;
      const auto end = list.items[i].end;
      return replaced(text, {{{end, end}, repeated(list.items[i].of(text), list.separator, count)}});
    }
    default:
      return replaced(text, {{list.items[i], std::string{list.items[j].of(text)}}});
  }
}

std::optional<std::string> edit_name(std::string_view text, const Structure& structure, const Vocabulary& vocabulary,
                                     Dice& dice) {
  if (structure.names.empty()) return std::nullopt;
  const auto& name = dice.pick(structure.names);
  const auto& other = dice.pick(structure.names);
  switch (dice.below(6)) {
    case 0:
      return replaced(text, {{name, misspelt(std::string{name.of(text)}, dice)}});
    case 1:
      return replaced(text, {{name, std::string{other.of(text)}}});
    case 2:
      if (!name.meets(other)) return exchanged(text, name, other);
      [[fallthrough]];
    default:
      if (vocabulary.names().empty()) return replaced(text, {{name, std::string{other.of(text)}}});
      return replaced(text, {{name, dice.pick(vocabulary.names())}});
  }
}

std::string edit(std::string_view text, const Format& format, const Vocabulary& vocabulary, Dice& dice) {
  const auto structure = format.structure(text);
  // Values are where most of the meaning is.
  for (int tries = 0; tries < 4; ++tries) {
    const auto kind = dice.below(8);
    const auto edited = kind < 3   ? edit_list(text, structure, dice)
                        : kind < 7 ? edit_value(text, structure, format, vocabulary, dice)
                                   : edit_name(text, structure, vocabulary, dice);
    if (edited && *edited != text) return *edited;
  }
  const auto word = vocabulary.words().empty() ? std::string{"\n"} : dice.pick(vocabulary.words());
  return std::string{text} + word;
}

std::string splice(std::string_view text, std::string_view other, const Format& format, Dice& dice) {
  const auto to = format.structure(text);
  const auto from = format.structure(other);
  for (int tries = 0; tries < 8; ++tries) {
    if (dice.one_in(2) && !to.values.empty() && !from.values.empty()) {
      return replaced(text, {{dice.pick(to.values).range, std::string{dice.pick(from.values).range.of(other)}}});
    }
    if (to.lists.empty() || from.lists.empty()) continue;
    const auto& into = dice.pick(to.lists);
    const auto& out_of = dice.pick(from.lists);
    if (into.level != out_of.level || into.items.empty() || out_of.items.empty()) continue;
    const auto item = dice.pick(out_of.items).of(other);
    if (into.named) {
      if (auto result = with_named(text, to, into.level, item)) return *std::move(result);
    }
    const auto& place = dice.pick(into.items);
    if (dice.one_in(2)) return replaced(text, {{place, std::string{item}}});
    return replaced(text, {{{place.end, place.end}, repeated(item, into.separator, 1)}});
  }
  return std::string{text};
}

}  // namespace kith::fuzzing
