#include "question_tokens.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "question_words.hpp"

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
    // Apostrophes as editors set them, and "what's", "robot's".
    for (auto at = token.text.find("\xE2\x80\x99"); at != std::string::npos; at = token.text.find("\xE2\x80\x99")) {
      token.text.replace(at, 3, "'");
    }
    if (token.text.size() > 2 && token.text.ends_with("'s")) token.text.resize(token.text.size() - 2);
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

namespace {

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  for (const auto& token : tokens_of(name)) words.push_back(token.text);
  return words;
}

// Words behind which a name of one word is that of a world.
bool introduces_world(const std::vector<Token>& tokens, std::size_t begin) {
  static const std::set<std::string> kArticles{"the", "a", "an"};
  static const std::set<std::string> kWords{"in", "during", "on", "at", "world", "mdp", "under"};
  while (begin > 0 && kArticles.count(tokens[begin - 1].text) != 0) --begin;
  return begin > 0 && kWords.count(tokens[begin - 1].text) != 0;
}

// Behind the name, if it begins here: "lift broken", or as people put it into a sentence, "lift is broken".
std::optional<std::size_t> end_of_world(const std::vector<std::string>& words, const std::vector<Token>& tokens,
                                        std::size_t begin) {
  auto at = begin;
  for (const auto& word : words) {
    while (at > begin && at < tokens.size() && tokens[at].text != word && is_auxiliary(tokens[at].text)) ++at;
    const bool is_plain =
        at < tokens.size() && (tokens[at].kind == Token::Kind::kWord || tokens[at].kind == Token::Kind::kNumber);
    if (!is_plain || tokens[at].text != word) return std::nullopt;
    ++at;
  }
  return words.empty() ? std::nullopt : std::optional{at};
}

bool is_state(const Domain& domain, const std::string& name) {
  if (domain.map()) return false;
  for (StateIndex s{0}; s.value() < domain.mdp(MdpIndex{0}).num_states(); ++s) {
    if (domain.state_name(MdpIndex{0}, s) == name) return true;
  }
  return false;
}

}  // namespace

std::vector<Token> with_world_names(const Domain& domain, std::vector<Token> tokens) {
  struct Name {
    std::vector<std::string> words;
    std::size_t world;
  };
  std::vector<Name> names;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    if (auto words = words_of(domain.world_name(m)); !words.empty()) names.push_back({std::move(words), m.value()});
  }
  std::stable_sort(names.begin(), names.end(),
                   [](const Name& a, const Name& b) { return a.words.size() > b.words.size(); });
  for (std::size_t i = 0; i < tokens.size() && !names.empty(); ++i) {
    if (tokens[i].kind == Token::Kind::kName) {
      const bool is_said = i > 0 && tokens[i - 1].text == "world";
      const auto found = domain.find_world(tokens[i].text);
      if (!found || (!is_said && is_state(domain, tokens[i].text))) continue;
      tokens[i].kind = Token::Kind::kWorld;
      tokens[i].number = found->value();
      continue;
    }
    for (const auto& name : names) {
      const auto end = end_of_world(name.words, tokens, i);
      if (!end || (name.words.size() == 1 && !introduces_world(tokens, i))) continue;
      const auto& last = tokens[*end - 1].place;
      tokens[i].kind = Token::Kind::kWorld;
      tokens[i].number = name.world;
      tokens[i].place.length = last.column + last.length - tokens[i].place.column;
      const auto next = tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      tokens.erase(next, tokens.begin() + static_cast<std::ptrdiff_t>(*end));
      break;
    }
  }
  return tokens;
}

}  // namespace kith::detail
