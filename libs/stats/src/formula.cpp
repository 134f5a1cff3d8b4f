#include "kith/stats/formula.hpp"

#include <algorithm>
#include <optional>

namespace kith {
namespace {

using Term = std::vector<std::size_t>;  // ascending indices of factors

constexpr std::size_t kMostTerms = 1'000;
constexpr int kDeepest = 100;  // parentheses

enum class TokenKind { kName, kNumber, kTilde, kPlus, kStar, kColon, kOpen, kClose, kEnd };

struct Token {
  TokenKind kind = TokenKind::kEnd;
  std::string text;
  std::size_t place = 0;  // offset in the text
};

bool is_name_byte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         static_cast<unsigned char>(c) >= 0x80;  // Part of a letter beyond ASCII.
}

bool is_number(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

bool is_plain_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_name_byte) && !is_number(text);
}

// Characters up to an offset, however many bytes each has.
std::size_t column_of(std::string_view text, std::size_t place) {
  const auto before = text.substr(0, place);
  return 1 + static_cast<std::size_t>(std::count_if(before.begin(), before.end(), [](char c) {
           return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
         }));
}

// A formula by recursive descent. After the first error the rest is not read: `failed()` ends every loop.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_{text} { advance(); }

  FormulaReading read() {
    read_response();
    if (!failed()) expect(TokenKind::kTilde, "'~' is missing after the response", "write RESPONSE ~ FACTOR + FACTOR");
    std::vector<Term> terms;
    if (!failed()) terms = read_sum(0);
    if (!failed() && token_.kind != TokenKind::kEnd) {
      if (token_.kind == TokenKind::kTilde) {
        fail("a second '~'", "a formula has one response");
      } else if (token_.kind == TokenKind::kClose) {
        fail("')' without '('", "");
      } else {
        fail("an operator is missing before '" + token_.text + "'", "join terms by +, * or :");
      }
    }
    if (failed()) return {{}, std::move(errors_)};
    // The empty term is the mean, which every model has.
    std::erase_if(terms, [](const Term& term) { return term.empty(); });
    std::stable_sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) { return a.size() < b.size(); });
    formula_.terms = std::move(terms);
    return {std::move(formula_), {}};
  }

 private:
  [[nodiscard]] bool failed() const { return !errors_.empty(); }

  void fail_at(std::size_t place, std::string message, std::string hint) {
    if (failed()) return;
    errors_.push_back({std::move(message), column_of(text_, place), std::move(hint)});
  }
  void fail(std::string message, std::string hint) { fail_at(token_.place, std::move(message), std::move(hint)); }

  void expect(TokenKind kind, const char* message, const char* hint) {
    if (token_.kind == kind) {
      advance();
    } else {
      fail(message, hint);
    }
  }

  void advance() {
    while (next_ < text_.size() && (text_[next_] == ' ' || text_[next_] == '\t')) ++next_;
    token_ = {TokenKind::kEnd, {}, next_};
    if (next_ == text_.size()) return;
    const char c = text_[next_];
    if (is_name_byte(c)) {
      read_word();
    } else if (c == '`') {
      read_quoted();
    } else {
      read_operator(c);
    }
  }

  void read_word() {
    const auto begin = next_;
    while (next_ < text_.size() && is_name_byte(text_[next_])) ++next_;
    token_.text = text_.substr(begin, next_ - begin);
    token_.kind = is_number(token_.text) ? TokenKind::kNumber : TokenKind::kName;
  }

  void read_quoted() {
    const auto end = text_.find('`', next_ + 1);
    if (end == std::string_view::npos) return fail("a name in back-quotes does not end", "close it with another `");
    token_.text = text_.substr(next_ + 1, end - next_ - 1);
    token_.kind = TokenKind::kName;
    next_ = end + 1;
    if (token_.text.empty()) fail("an empty name", "");
  }

  void read_operator(char c) {
    static constexpr std::string_view kOperators = "~+*:()";
    static constexpr TokenKind kKinds[] = {TokenKind::kTilde, TokenKind::kPlus, TokenKind::kStar,
                                           TokenKind::kColon, TokenKind::kOpen, TokenKind::kClose};
    const auto index = kOperators.find(c);
    token_.text = std::string{c};
    if (index == std::string_view::npos) {
      return fail("'" + token_.text + "' has no meaning in a formula",
                  "operators are +, *, : and parentheses; other names go in `back-quotes`");
    }
    token_.kind = kKinds[index];
    ++next_;
  }

  void read_response() {
    if (failed()) return;
    if (token_.kind != TokenKind::kName) return fail("the response is missing", "write RESPONSE ~ FACTOR + FACTOR");
    formula_.response = token_.text;
    advance();
  }

  // sum: product { "+" product }
  std::vector<Term> read_sum(int depth) {
    auto terms = read_product(depth);
    while (!failed() && token_.kind == TokenKind::kPlus) {
      advance();
      unite(terms, read_product(depth));
    }
    return terms;
  }

  // product: crossing { "*" crossing }, where a * b means a + b + a:b
  std::vector<Term> read_product(int depth) {
    auto terms = read_crossing(depth);
    while (!failed() && token_.kind == TokenKind::kStar) {
      advance();
      const auto right = read_crossing(depth);
      const auto both = cross(terms, right);
      unite(terms, right);
      unite(terms, both);
    }
    return terms;
  }

  // crossing: operand { ":" operand }
  std::vector<Term> read_crossing(int depth) {
    auto terms = read_operand(depth);
    while (!failed() && token_.kind == TokenKind::kColon) {
      advance();
      terms = cross(terms, read_operand(depth));
    }
    return terms;
  }

  // operand: name | "1" | "(" sum ")"
  std::vector<Term> read_operand(int depth) {
    if (failed()) return {};
    if (token_.kind == TokenKind::kName) return read_factor();
    if (token_.kind == TokenKind::kNumber) {
      if (token_.text == "1") {
        advance();
        return {Term{}};
      }
      fail("'" + token_.text + "' is not a factor",
           token_.text == "0" ? "every model here has a mean" : "a name of digits goes in `back-quotes`");
      return {};
    }
    if (token_.kind == TokenKind::kOpen) {
      if (depth == kDeepest) {
        fail("too many parentheses in each other", "");
        return {};
      }
      const auto open = token_.place;
      advance();
      auto terms = read_sum(depth + 1);
      if (token_.kind != TokenKind::kClose) {
        if (token_.kind == TokenKind::kEnd) fail_at(open, "'(' without ')'", "");
        fail("an operator is missing before '" + token_.text + "'", "join terms by +, * or :");
        return {};
      }
      advance();
      return terms;
    }
    if (token_.kind == TokenKind::kEnd) {
      fail("a factor is missing at the end", "write ~ 1 for the mean alone");
    } else {
      fail("a factor is missing before '" + token_.text + "'", "");
    }
    return {};
  }

  std::vector<Term> read_factor() {
    if (token_.text == formula_.response) {
      fail("the response '" + token_.text + "' cannot be a factor as well", "");
      return {};
    }
    const auto known = std::find(formula_.factors.begin(), formula_.factors.end(), token_.text);
    const auto index = static_cast<std::size_t>(known - formula_.factors.begin());
    if (known == formula_.factors.end()) formula_.factors.push_back(token_.text);
    advance();
    return {{index}};
  }

  // The terms of both, without repetition.
  void unite(std::vector<Term>& terms, const std::vector<Term>& more) {
    for (const auto& term : more) {
      if (std::find(terms.begin(), terms.end(), term) == terms.end()) terms.push_back(term);
    }
    if (terms.size() > kMostTerms) fail_at(0, "more than 1000 terms", "use + in place of *");
  }

  // Every term of the one with every term of the other.
  std::vector<Term> cross(const std::vector<Term>& left, const std::vector<Term>& right) {
    std::vector<Term> crossed;
    for (const auto& a : left) {
      std::vector<Term> row;
      for (const auto& b : right) {
        Term both;
        std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        row.push_back(std::move(both));
      }
      unite(crossed, row);
      if (failed()) break;
    }
    return crossed;
  }

  std::string_view text_;
  std::size_t next_ = 0;
  Token token_;
  Formula formula_;
  std::vector<FormulaError> errors_;
};

std::string quoted(const std::string& name) { return is_plain_name(name) ? name : "`" + name + "`"; }

}  // namespace

FormulaReading parse_formula(std::string_view text) { return Parser{text}.read(); }

std::string to_string(const Formula& formula) {
  std::string text = quoted(formula.response) + " ~ ";
  if (formula.terms.empty()) return text + "1";
  for (std::size_t t = 0; t < formula.terms.size(); ++t) {
    if (t > 0) text += " + ";
    for (std::size_t i = 0; i < formula.terms[t].size(); ++i)
      text += (i > 0 ? ":" : "") + quoted(formula.factors.at(formula.terms[t][i]));
  }
  return text;
}

}  // namespace kith
