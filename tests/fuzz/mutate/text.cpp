#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <sstream>
#include <vector>

#include "mutate.hpp"

namespace kith::fuzzing {
namespace {

const std::vector<std::string>& numbers() {
  static const auto kNumbers = [] {
    std::istringstream words{
        "0 1 -1 2 3 7 12 255 65536 2147483648 9223372036854775808 -0.0 0.5 1.0 -1.5 1e-9 1e-320 1e308 1e309 inf nan "
        "0.1 "
        "1.0000000000000002 1/3 0x1F 1_000 +5 .5 01 1979-05-27"};
    return std::vector<std::string>{std::istream_iterator<std::string>{words}, {}};
  }();
  return kNumbers;
}
constexpr std::array<std::string_view, 8> kOthers{"", "true", "null", "[]", "{}", "[1, \"a\"]", "NA", "\"\""};

enum class Kind { kNumber, kName, kQuoted };

struct Word {
  std::size_t begin, size;
  Kind kind;
};

bool is_in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' || c == '+';
}

// Names, numbers, and what is between quotes on one line.
std::vector<Word> words_of(std::string_view text) {
  std::vector<Word> words;
  for (std::size_t at = 0; at < text.size(); ++at) {
    auto end = at;
    if (text[at] == '"') {
      end = text.find_first_of("\"\n", at + 1);
      if (end != std::string_view::npos && text[end] == '"') words.push_back({at + 1, end - at - 1, Kind::kQuoted});
      at = std::min(end, text.size());
      continue;
    }
    while (end < text.size() && is_in_word(text[end])) ++end;
    if (end == at) continue;
    const auto first = text.find_first_not_of("+-.", at);
    const bool is_number = first < end && std::isdigit(static_cast<unsigned char>(text[first])) != 0;
    words.push_back({at, end - at, is_number ? Kind::kNumber : Kind::kName});
    at = end - 1;
  }
  return words;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size() - 1) + 1;
    lines.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line;
  return text;
}

// What could stand in a word's place: of the text itself, of the vocabulary, or what is odd.
std::string other_word(std::string_view text, const std::vector<Word>& words, Kind kind, const Vocabulary& vocabulary,
                       Dice& dice) {
  const auto& another = dice.pick(words);
  if (another.kind == kind || dice.one_in(8)) return std::string{text.substr(another.begin, another.size)};
  if (dice.one_in(12)) return std::string{dice.pick(kOthers)};
  if (kind == Kind::kNumber) return dice.pick(numbers());
  const auto& known = kind == Kind::kName ? vocabulary.names() : vocabulary.words();
  return known.empty() ? dice.pick(numbers()) : dice.pick(known);
}

std::string with_lines_changed(std::vector<std::string> lines, Dice& dice) {
  const auto a = dice.below(lines.size()), b = dice.below(lines.size());
  const auto at = [&](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  switch (dice.below(4)) {
    case 0:
      lines.erase(at(a));
      break;
    case 1:
      lines.insert(at(b), std::string{lines[a]});
      break;
    case 2:
      std::swap(lines[a], lines[b]);
      break;
    default:  // a table or some rows
      lines.erase(at(std::min(a, b)), at(std::max(a, b)));
  }
  return joined(lines);
}

}  // namespace

std::string mutate_text(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  const auto words = words_of(text);
  if (words.empty()) return mutate_bytes(text, dice);
  if (dice.one_in(3)) return with_lines_changed(lines_of(text), dice);
  const auto& word = dice.pick(words);
  const auto other = other_word(text, words, word.kind, vocabulary, dice);
  return std::string{text}.replace(word.begin, word.size, other);
}

std::string cross_text(std::string_view text, std::string_view other, Dice& dice) {
  const auto words = words_of(text), other_words = words_of(other);
  if (words.empty() || other_words.empty()) return std::string{other};
  if (dice.one_in(2)) {
    const auto &to = dice.pick(words), &from = dice.pick(other_words);
    return std::string{text}.replace(to.begin, to.size, other.substr(from.begin, from.size));
  }
  auto lines = lines_of(text);
  const auto taken = lines_of(other);
  const auto first = taken.begin() + static_cast<std::ptrdiff_t>(dice.below(taken.size()));
  const auto most = std::min<std::size_t>(4, static_cast<std::size_t>(taken.end() - first));
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(dice.below(lines.size() + 1)), first,
               first + static_cast<std::ptrdiff_t>(1 + dice.below(most)));
  return joined(lines);
}

}  // namespace kith::fuzzing
