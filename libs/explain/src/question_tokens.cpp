#include "question_tokens.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>
#include <set>

#include "question_words.hpp"

namespace kith::detail {
namespace {

// Numbers that nothing here reaches count as the largest.
std::size_t number_of(std::string digits) {
  constexpr std::size_t kMostDigits = 9;
  std::erase(digits, ',');
  return digits.size() > kMostDigits ? 1'000'000'000 : static_cast<std::size_t>(std::stoul(digits));
}

// The forms of tokens, tried in this order; the first group of a pair, and the second one, are its numbers.
struct Form {
  Token::Kind kind;
  std::regex form;
};

const std::vector<Form>& forms() {
  using Kind = Token::Kind;
  static const std::vector<Form> kForms{
      {Kind::kName, std::regex{R"("([^"]+)\"|'([^']+)')"}},
      {Kind::kSign, std::regex{R"(-\d+(\.\d+)?)"}},
      {Kind::kNumber, std::regex{R"(\d{1,3}(,\d{3})+(?![\d,]))"}},
      {Kind::kSign, std::regex{R"(\d+\.\d+,\d+|\d+ *, *\d+\.\d+|\d+(\.\d+){2,}|\d+ *, *\d+( *, *\d+)+)"}},
      {Kind::kCell, std::regex{R"((\d+)[ ,]*,[ ,]*(\d+))"}},
      {Kind::kFraction, std::regex{R"((\d*)\.(\d{1,3})(?!\d)|(\d+)/(\d{1,3})(?!\d))"}},
      {Kind::kNumber, std::regex{R"(\d+(?![\w/]|\.\d))"}},
      {Kind::kWord, std::regex{"[A-Za-z\x80-\xFF][A-Za-z0-9_'\x80-\xFF-]*"}},
      {Kind::kSign, std::regex{R"(\d[\w./]*|[^\s,?.!;:()'"])"}},
  };
  return kForms;
}

// In lower case, apostrophes as on keyboards, and without the "'s" of "what's" and "robot's".
std::string spelled(const std::string& text) {
  std::string word;
  for (const char c : text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (auto at = word.find("\xE2\x80\x99"); at != std::string::npos; at = word.find("\xE2\x80\x99"))
    word.replace(at, 3, "'");
  if (word.size() > 2 && word.ends_with("'s")) word.resize(word.size() - 2);
  return word;
}

Token token_of(Token::Kind kind, const std::cmatch& found, std::size_t begin) {
  const auto group = [&](std::size_t i) { return found[i].matched ? found[i].str() : std::string{}; };
  Token token{kind, spelled(found.str()), 0, 0, {begin + 1, static_cast<std::size_t>(found.length())}};
  if (kind == Token::Kind::kName) {
    token.text = group(1) + group(2);
    token.place = {begin + 2, token.text.size()};
  } else if (kind == Token::Kind::kNumber) {
    token.number = number_of(token.text);
  } else if (kind == Token::Kind::kCell) {
    token.number = number_of(group(1));
    token.row = number_of(group(2));
  } else if (kind == Token::Kind::kFraction) {
    const bool is_decimal = found[2].matched;
    token.row = 1;
    for (std::size_t i = 0; is_decimal && i < group(2).size(); ++i) token.row *= 10;
    token.number = is_decimal ? number_of("0" + group(1) + group(2)) : number_of(group(3));
    if (!is_decimal) token.row = number_of(group(4));
    if (token.row == 0) token.kind = Token::Kind::kSign;
  }
  return token;
}

}  // namespace

std::vector<Token> tokens_of(const std::string& text) {
  std::vector<Token> tokens;
  for (std::size_t i = 0; i < text.size();) {
    const auto begin = i++;
    for (const auto& [kind, form] : forms()) {
      std::cmatch found;
      if (!std::regex_search(text.c_str() + begin, found, form, std::regex_constants::match_continuous)) continue;
      const bool is_in_cell = begin > 0 && text[begin - 1] == '(';
      if (kind == Token::Kind::kNumber && is_in_cell && found.str().find(',') != std::string::npos) continue;
      tokens.push_back(token_of(kind, found, begin));
      i = begin + static_cast<std::size_t>(found.length());
      break;
    }
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
    const bool is_plain = at < tokens.size() && tokens[at].kind != Token::Kind::kName;
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
      if (name.words.size() == 1 && tokens[i].kind == Token::Kind::kNumber) continue;  // its number comes first
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
