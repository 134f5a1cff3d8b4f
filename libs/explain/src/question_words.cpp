#include "question_words.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "kith/core/text.hpp"

namespace kith::detail {
namespace {

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::istringstream stream{text};
  std::vector<std::string> parts;
  for (std::string part; std::getline(stream, part, separator);) {
    part.erase(0, part.find_first_not_of(' '));
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

// "in/on time" is "in time" and "on time".
std::vector<std::string> spelled_out(const std::string& phrase) {
  std::vector<std::string> all{""};
  for (const auto& word : parts_of(phrase, ' ')) {
    std::vector<std::string> longer;
    for (const auto& begin : all) {
      for (const auto& form : parts_of(word, '/')) longer.push_back(begin + (begin.empty() ? "" : " ") + form);
    }
    all = std::move(longer);
  }
  return all;
}

constexpr std::pair<Meaning, const char*> kTable[] = {
#define KITH_WORDS(meaning, phrases) {Meaning::meaning, phrases},
#include "question_words.def"
};

std::vector<std::vector<std::string>> rows_of(Meaning meaning) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : words_that_mean(meaning)) rows.push_back(parts_of(row, '/'));
  return rows;
}

}  // namespace

Meanings meanings_of(const std::string& phrase) {
  static const auto kMeanings = [] {
    std::map<std::string, Meanings> all;
    for (const auto& [meaning, phrases] : kTable) {
      if (meaning == Meaning::kSynonyms || meaning == Meaning::kForms) continue;
      for (const auto& one : parts_of(phrases, ',')) {
        for (const auto& form : spelled_out(one)) all[form] |= one_of(meaning);
      }
    }
    return all;
  }();
  const auto at = kMeanings.find(phrase);
  return at == kMeanings.end() ? 0 : at->second;
}

std::vector<std::string> words_that_mean(Meaning meaning) {
  return parts_of(kTable[static_cast<std::size_t>(meaning)].second, ',');
}

const std::vector<std::vector<std::string>>& synonyms() {
  static const auto kRows = rows_of(Meaning::kSynonyms);
  return kRows;
}

std::string stem(std::string word) {
  static const auto kForms = rows_of(Meaning::kForms);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word.size() > 2 && word.ends_with("'s")) word.resize(word.size() - 2);
  const auto form = std::find_if(kForms.begin(), kForms.end(), [&](const auto& row) { return row.front() == word; });
  if (form != kForms.end()) word = form->back();
  constexpr std::size_t kShort = 4;
  const auto drop = [&](std::size_t n) { word.resize(word.size() - n); };
  if (word.size() > kShort && word.ends_with("ing")) {
    drop(3);
  } else if (word.size() > kShort && (word.ends_with("ies") || word.ends_with("ed"))) {
    drop(2);
  } else if (word.size() > 3 && word.ends_with("s")) {
    drop(1);
  }
  if (word.size() > 3 && word.ends_with("e")) drop(1);
  if (word.size() > 3 && word.back() == word[word.size() - 2]) drop(1);
  if (word.size() > 3 && word.back() == 'y') word.back() = 'i';
  return word;
}

bool is_contact(const std::string& stem_of_word) {
  static const auto kStems = [] {
    std::set<std::string> stems;
    for (const auto& word : words_that_mean(Meaning::kContact)) stems.insert(stem(word));
    return stems;
  }();
  return kStems.count(stem_of_word) != 0;
}

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
  static const std::vector<Form> kForms{
      {Token::Kind::kQuoted, std::regex{R"("([^"]+)\"|'([^']+)')"}},
      {Token::Kind::kSign, std::regex{R"(-\d+(\.\d+)?)"}},
      {Token::Kind::kNumber, std::regex{R"(\d{1,3}(,\d{3})+(?![\d,]))"}},
      {Token::Kind::kSign, std::regex{R"(\d+\.\d+,\d+|\d+ *, *\d+\.\d+|\d+(\.\d+){2,}|\d+ *, *\d+( *, *\d+)+)"}},
      {Token::Kind::kCell, std::regex{R"((\d+)[ ,]*,[ ,]*(\d+))"}},
      {Token::Kind::kFraction, std::regex{R"((\d*)\.(\d{1,3})(?!\d)|(\d+)/(\d{1,3})(?!\d))"}},
      {Token::Kind::kNumber, std::regex{R"(\d+(?![\w/]|\.\d))"}},
      {Token::Kind::kWord, std::regex{"[A-Za-z\x80-\xFF][A-Za-z0-9_'\x80-\xFF-]*"}},
      {Token::Kind::kComma, std::regex{","}},
      {Token::Kind::kSign, std::regex{R"(\d[\w./]*|[^\s,?.!;:()'"])"}},
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
  if (kind == Token::Kind::kQuoted) {
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
      auto& word = tokens.back().text;
      const bool denies = kind == Token::Kind::kWord && word.size() > 3 && (word.ends_with("n't") || word == "cannot");
      if (denies) {  // "doesn't" is "does not"
        word.resize(word.size() - 3);
        const auto place = tokens.back().place;
        tokens.push_back({Token::Kind::kWord, "not", 0, 0, place});
      }
      i = begin + static_cast<std::size_t>(found.length());
      break;
    }
  }
  return tokens;
}

std::vector<Token> with_phrases(const std::vector<Token>& tokens) {
  std::vector<Token> joined;
  for (std::size_t i = 0; i < tokens.size();) {
    auto best = tokens[i];
    std::size_t length = 1;
    best.meanings = best.kind == Token::Kind::kWord ? meanings_of(best.text) : 0;
    auto phrase = tokens[i].text;
    const auto is_word = [&](std::size_t at) { return at < tokens.size() && tokens[at].kind == Token::Kind::kWord; };
    for (auto end = i + 1; is_word(i) && is_word(end) && end < i + kLongestPhrase; ++end) {
      phrase += " " + tokens[end].text;
      const auto meanings = meanings_of(phrase);
      if (meanings == 0) continue;
      const auto& last = tokens[end].place;
      best = {Token::Kind::kWord,
              phrase,
              0,
              0,
              {best.place.column, last.column + last.length - best.place.column},
              meanings};
      length = end + 1 - i;
    }
    joined.push_back(best);
    i += length;
  }
  return joined;
}

std::vector<std::string> texts_of(const std::vector<Token>& tokens) {
  std::vector<std::string> texts;
  for (const auto& token : tokens) texts.push_back(token.text);
  return texts;
}

std::string phrase(const std::vector<Token>& tokens) { return joined(tokens, " ", &Token::text); }

Place place_of(const std::vector<Token>& tokens) {
  const auto &first = tokens.front().place, &last = tokens.back().place;
  return {first.column, last.column + last.length - first.column};
}

}  // namespace kith::detail
