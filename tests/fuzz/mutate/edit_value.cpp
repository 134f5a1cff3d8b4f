#include <algorithm>
#include <array>

#include "edit.hpp"

namespace kith::fuzzing {
namespace {

using std::string_literals::operator""s;

const std::vector<std::string>& odd_texts() {
  static const std::vector<std::string> kTexts{"",
                                               " ",
                                               "a",
                                               "A",
                                               "0",
                                               "-",
                                               ".",
                                               "..",
                                               "a b",
                                               "a,b",
                                               "a\"b",
                                               "\\",
                                               "\n",
                                               "\t",
                                               "#",
                                               "\xC3\xA4",
                                               "\xE2\x82\xAC",
                                               "\xF0\x9F\x99\x82",
                                               "\x7F",
                                               "\x01",
                                               std::string(300, 'a'),
                                               "true",
                                               "1.5",
                                               "[]",
                                               "{}",
                                               "/",
                                               "../a",
                                               "NA"};
  return kTexts;
}

// A number near another, or far from it.
std::string neighbour(std::string_view word, Dice& dice) {
  std::string number{word};
  const auto at = dice.below(number.size());
  switch (dice.below(8)) {
    case 0:
      return number.front() == '-' ? number.substr(1) : "-" + number;
    case 1:
      return number + "0";
    case 2:
      return number + "e" + std::to_string(dice.below(20));
    case 3:
      return number + "." + std::to_string(dice.below(100));
    case 4:
      return number.size() > 1 ? number.erase(at, 1) : "0"s;
    case 5:
      return number.insert(at, 1, static_cast<char>('0' + dice.below(10)));
    default:
      if (number[at] >= '0' && number[at] <= '9') number[at] = static_cast<char>('0' + dice.below(10));
      return number;
  }
}

std::string text_of(std::string_view quoted) {
  const bool has_quotes = quoted.size() >= 2 && (quoted.front() == '"' || quoted.front() == '\'');
  return std::string{has_quotes ? quoted.substr(1, quoted.size() - 2) : quoted};
}

// A text that has much in common with another: a character changed, some moved, a word put in.
std::string varied_text(std::string text, const Vocabulary& vocabulary, Dice& dice) {
  const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  if (!ascii) return text + "x";  // changed elsewhere, byte by byte
  const auto at = dice.below(text.size() + 1);
  const auto n = dice.below(text.size() + 1 - at);
  switch (dice.below(6)) {
    case 0:
      return text.erase(at, dice.one_in(2) ? 1 : n);
    case 1:
      return text.insert(at, vocabulary.words().empty() ? "x" : dice.pick(vocabulary.words()));
    case 2:
      return text.insert(at, text.substr(at, n));
    case 3:
      if (!text.empty()) text.insert(at, 1, text[dice.below(text.size())]);
      return text;
    case 4:
      if (!text.empty()) std::swap(text[at % text.size()], text[dice.below(text.size())]);
      return text;
    default:
      if (!text.empty()) text[at % text.size()] = dice.pick("SG#.rR-:!|/ 019az,_"s);
      return text;
  }
}

}  // namespace

std::string value_of_kind(ValueKind kind, std::string_view word, const Format& format, const Vocabulary& vocabulary,
                          Dice& dice) {
  switch (kind) {
    case ValueKind::kInteger:
      return std::string{dice.pick(format.integers)};
    case ValueKind::kReal:
      return std::string{dice.pick(format.reals)};
    case ValueKind::kBoolean:
      return dice.one_in(2) ? "true" : "false";
    case ValueKind::kText: {
      if (dice.one_in(2)) return format.quoted(varied_text(text_of(word), vocabulary, dice));
      const bool known = !vocabulary.names().empty() && dice.one_in(2);
      return format.quoted(known ? dice.pick(vocabulary.names()) : dice.pick(odd_texts()));
    }
    case ValueKind::kCompound:
    case ValueKind::kOther:
      break;
  }
  return std::string{dice.pick(format.others)};
}

std::optional<std::string> edit_value(std::string_view text, const Structure& structure, const Format& format,
                                      const Vocabulary& vocabulary, Dice& dice) {
  if (structure.values.empty()) return std::nullopt;
  const auto& value = dice.pick(structure.values);
  const auto& other = dice.pick(structure.values);
  const auto word = value.range.of(text);
  const auto put = [&](std::string now) { return replaced(text, {{value.range, std::move(now)}}); };
  const bool is_number = value.kind == ValueKind::kInteger || value.kind == ValueKind::kReal;
  switch (dice.below(10)) {
    case 0:
    case 1:
    case 2:
      if (is_number && !word.empty() && dice.one_in(2)) return put(neighbour(word, dice));
      return put(value_of_kind(value.kind, word, format, vocabulary, dice));
    case 3:
    case 4: {
      if (is_number && !word.empty()) return put(neighbour(word, dice));
      return put(value_of_kind(value.kind, word, format, vocabulary, dice));
    }
    case 5: {
      constexpr std::array<ValueKind, 5> kKinds{ValueKind::kInteger, ValueKind::kReal, ValueKind::kText,
                                                ValueKind::kBoolean, ValueKind::kOther};
      return put(value_of_kind(dice.pick(kKinds), word, format, vocabulary, dice));
    }
    case 6:
      if (format.around.empty()) return std::nullopt;
      {
        const auto& [before, behind] = dice.pick(format.around);
        return put(std::string{before} + std::string{word} + std::string{behind});
      }
    case 7:
      if (value.range.meets(other.range)) return std::nullopt;
      return replaced(text, {{value.range, std::string{other.range.of(text)}}, {other.range, std::string{word}}});
    default:
      if (other.kind != value.kind && !dice.one_in(4)) return std::nullopt;
      return put(std::string{other.range.of(text)});
  }
}

}  // namespace kith::fuzzing
