#include "kith/stats/formula.hpp"

#include <algorithm>

namespace kith {
namespace {

using Term = std::vector<std::size_t>;  // ascending indices of factors

constexpr std::size_t kMostTerms = 1'000;
constexpr std::size_t kMostRandomIntercepts = 10;
constexpr int kDeepest = 100;  // parentheses
constexpr const char* kRandomHint = "write (1|team), (1|team:member) or (1|team/member)";

enum class TokenKind { kName, kNumber, kTilde, kPlus, kStar, kColon, kSlash, kBar, kOpen, kClose, kEnd };

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

std::string quoted(const std::string& name) { return is_plain_name(name) ? name : "`" + name + "`"; }

std::string joined(const std::vector<std::string>& columns) {
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ":") + quoted(column);
  return text;
}

std::vector<std::string> columns_of(const Formula& formula, const Term& term) {
  std::vector<std::string> columns;
  for (const auto factor : term) columns.push_back(formula.factors.at(factor));
  return columns;
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
      } else if (token_.kind == TokenKind::kBar) {
        fail("'|' outside parentheses", kRandomHint);
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
    check_random_intercepts();
    if (failed()) return {{}, std::move(errors_)};
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
    static constexpr std::string_view kOperators = "~+*:/|()";
    static constexpr TokenKind kKinds[] = {TokenKind::kTilde, TokenKind::kPlus, TokenKind::kStar, TokenKind::kColon,
                                           TokenKind::kSlash, TokenKind::kBar,  TokenKind::kOpen, TokenKind::kClose};
    const auto index = kOperators.find(c);
    token_.text = std::string{c};
    if (index == std::string_view::npos) {
      return fail("'" + token_.text + "' has no meaning in a formula",
                  "operators are +, *, : and parentheses; other names go in `back-quotes`");
    }
    token_.kind = kKinds[index];
    ++next_;
    if (token_.kind == TokenKind::kSlash && !in_groups_)
      fail("'/' outside a random intercept", "write a + a:b for levels of b within those of a");
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
    const auto random_before = formula_.random_intercepts.size();
    auto terms = read_crossing(depth);
    while (!failed() && token_.kind == TokenKind::kStar) {
      require_no_random_since(random_before);
      advance();
      const auto right = read_crossing(depth);
      const auto both = cross(terms, right);
      require_no_random_since(random_before);
      unite(terms, right);
      unite(terms, both);
    }
    return terms;
  }

  // crossing: operand { ":" operand }
  std::vector<Term> read_crossing(int depth) {
    const auto random_before = formula_.random_intercepts.size();
    auto terms = read_operand(depth);
    while (!failed() && token_.kind == TokenKind::kColon) {
      require_no_random_since(random_before);
      advance();
      terms = cross(terms, read_operand(depth));
      require_no_random_since(random_before);
    }
    return terms;
  }

  // A random intercept is no operand of * and :.
  void require_no_random_since(std::size_t before) {
    if (formula_.random_intercepts.size() == before) return;
    fail_at(random_place_, "a random intercept cannot be part of a product", "add it to the terms with +");
  }

  // operand: name | "1" | "(" sum ")" | "(" "1" "|" groups ")"
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
      if (token_.kind == TokenKind::kNumber && token_.text == "1" && next_is('|')) {
        read_random_intercept(open);
        return {};
      }
      auto terms = read_sum(depth + 1);
      if (token_.kind == TokenKind::kBar) fail("only intercepts can be random, not slopes", kRandomHint);
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

  [[nodiscard]] bool next_is(char c) const {
    const auto next = text_.find_first_not_of(" \t", next_);
    return next != std::string_view::npos && text_[next] == c;
  }

  // The rest of "(1|a:b)" or "(1|a/b)" from "1" on; a/b means a + a:b.
  void read_random_intercept(std::size_t open) {
    random_place_ = open;
    in_groups_ = true;
    advance();
    advance();
    std::vector<std::string> columns;
    do {
      if (token_.kind == TokenKind::kSlash) {
        add_random_intercept(columns);
        advance();
      } else if (token_.kind == TokenKind::kColon) {
        advance();
      }
      read_group(columns);
    } while (!failed() && (token_.kind == TokenKind::kSlash || token_.kind == TokenKind::kColon));
    in_groups_ = false;
    if (token_.kind == TokenKind::kEnd) fail_at(open, "'(' without ')'", "");
    if (token_.kind != TokenKind::kClose)
      fail("'" + token_.text + "' in the groups of a random intercept", kRandomHint);
    if (failed()) return;
    add_random_intercept(columns);
    advance();
  }

  void read_group(std::vector<std::string>& columns) {
    if (failed()) return;
    if (token_.kind != TokenKind::kName)
      return fail("the name of a column is missing after '|', ':' or '/'", kRandomHint);
    if (token_.text == formula_.response)
      return fail("the response '" + token_.text + "' cannot be a random intercept as well", "");
    if (std::find(columns.begin(), columns.end(), token_.text) == columns.end()) columns.push_back(token_.text);
    advance();
  }

  void add_random_intercept(const std::vector<std::string>& columns) {
    auto& known = formula_.random_intercepts;
    const auto is_same = [&](const std::vector<std::string>& other) {
      return std::is_permutation(columns.begin(), columns.end(), other.begin(), other.end());
    };
    if (std::any_of(known.begin(), known.end(), is_same)) return;
    if (known.size() == kMostRandomIntercepts) return fail_at(random_place_, "more than 10 random intercepts", "");
    known.push_back(columns);
  }

  // Of what is a term already, a random intercept explains nothing.
  void check_random_intercepts() {
    for (const auto& columns : formula_.random_intercepts) {
      for (const auto& term : formula_.terms) {
        const auto names = columns_of(formula_, term);
        if (std::is_permutation(names.begin(), names.end(), columns.begin(), columns.end()))
          fail_at(random_place_, "'" + joined(columns) + "' is both a term and a random intercept",
                  "leave one of them out");
      }
    }
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
  bool in_groups_ = false;
  std::size_t random_place_ = 0;  // of the latest random intercept
  Formula formula_;
  std::vector<FormulaError> errors_;
};

}  // namespace

FormulaReading parse_formula(std::string_view text) { return Parser{text}.read(); }

std::string to_string(const Formula& formula) {
  std::string text = quoted(formula.response) + " ~ ";
  std::string sum;
  const auto add = [&sum](const std::string& part) { sum += (sum.empty() ? "" : " + ") + part; };
  for (const auto& term : formula.terms) {
    add(joined(columns_of(formula, term)));
  }
  if (sum.empty()) sum = "1";
  for (const auto& columns : formula.random_intercepts) add("(1|" + joined(columns) + ")");
  return text + sum;
}

}  // namespace kith
