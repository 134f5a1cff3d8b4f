#include "question_tokens.hpp"

#include <cctype>
#include <optional>

namespace kith::detail {
namespace {

std::size_t number_of(const std::string& digits) {
  constexpr std::size_t kMaxDigits = 9;
  return digits.size() > kMaxDigits ? 1'000'000'000 : static_cast<std::size_t>(std::stoul(digits));
}

// The end of a name in quotes that begin at `i`, or nothing: "'" also stands within words.
std::optional<std::size_t> end_of_name(const std::string& text, std::size_t i) {
  if (text[i] != '"' && text[i] != '\'') return std::nullopt;
  const auto end = text.find(text[i], i + 1);
  return end == std::string::npos || end == i + 1 ? std::nullopt : std::optional{end};
}

// Also of words in other scripts, which are then unknown words rather than none.
bool is_letter(unsigned char c) {
  constexpr unsigned char kLastAscii = 0x7F;
  return c > kLastAscii || std::isalnum(c) != 0;
}

}  // namespace

std::vector<Token> tokens_of(const std::string& text) {
  const auto is = [&](std::size_t i, auto predicate) {
    return i < text.size() && predicate(static_cast<unsigned char>(text[i])) != 0;
  };
  std::vector<Token> tokens;
  bool comma = false;  // between the last token and this one
  for (std::size_t i = 0; i < text.size();) {
    const bool digit = is(i, [](unsigned char c) { return std::isdigit(c); });
    const auto belongs = [digit](unsigned char c) {
      return digit ? std::isdigit(c) != 0 : is_letter(c) || c == '_' || c == '-' || c == '\'';
    };
    if (const auto end = end_of_name(text, i)) {
      tokens.push_back({Token::Kind::kName, text.substr(i + 1, *end - i - 1), 0, 0, {i + 2, *end - i - 1}});
      i = *end + 1;
      comma = false;
      continue;
    }
    if (!is(i, [](unsigned char c) { return is_letter(c); })) {
      comma = comma || text[i] == ',';
      ++i;
      continue;
    }
    const auto begin = i;
    while (is(i, belongs)) ++i;
    Token token;
    token.place = {begin + 1, i - begin};
    for (const char c : text.substr(begin, i - begin)) {
      token.text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (digit) {
      token.kind = Token::Kind::kNumber;
      token.number = number_of(token.text);
    }
    const bool pair = digit && comma && !tokens.empty() && tokens.back().kind == Token::Kind::kNumber;
    if (pair) {
      tokens.back().kind = Token::Kind::kCell;
      tokens.back().row = token.number;
      tokens.back().place.length = i + 1 - tokens.back().place.column;
    } else {
      tokens.push_back(token);
    }
    comma = false;
  }
  return tokens;
}

}  // namespace kith::detail
