// "Is rubble worse than two steps?" as an inequality of reward weights.
#include "comparison.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <sstream>

#include "question_words.hpp"

namespace kith::detail {
namespace {

// What a word does in a comparison. Costs and gains are amounts, so that "costs more than 2 steps" is about what 2
// steps cost, and so is "is worth more than 2 steps"; what is worse or better is so by its weight.
enum class Role { kNone, kCost, kGain, kWorse, kBetter, kRather, kWeighs, kMore, kLess, kSomething, kNothing };

const std::map<std::string, Role>& roles() {
  static const std::map<std::string, Role> kRoles = [] {
    std::map<std::string, Role> result;
    const auto add = [&](Role role, const char* words) {
      std::istringstream stream{words};
      for (std::string word; stream >> word;) result.emplace(word, role);
    };
    add(Role::kCost,
        "cost costs costing mind minds dislike dislikes hate hates fear fears bother bothers punish punishes detest "
        "detests");
    add(Role::kGain, "worth like likes love loves enjoy enjoys valuable gain gains");
    add(Role::kWorse, "worse expensive costly dangerous harmful unpleasant bad");
    add(Role::kBetter, "better cheaper good");
    add(Role::kRather, "rather prefer prefers preferring");
    add(Role::kWeighs, "outweigh outweighs important matter matters");
    add(Role::kMore, "more");
    add(Role::kLess, "less fewer");
    add(Role::kSomething, "something anything");
    add(Role::kNothing, "nothing");
    return result;
  }();
  return kRoles;
}

Role role_of(const Token& token) {
  const auto at = roles().find(token.text);
  return token.kind != Token::Kind::kWord || at == roles().end() ? Role::kNone : at->second;
}

bool is_one_of(const Token& token, std::initializer_list<const char*> words) {
  return token.kind == Token::Kind::kWord &&
         std::any_of(words.begin(), words.end(), [&](const char* word) { return token.text == word; });
}

// Where one side ends and the other begins: at "than", "or" or "outweighs", or, behind "prefer", at "to" or "over".
std::optional<std::size_t> separator(const Lexicon& lexicon, const std::vector<Token>& tokens) {
  const auto find = [&](std::size_t from, std::initializer_list<const char*> words) {
    while (from < tokens.size() && !is_one_of(tokens[from], words)) ++from;
    return from < tokens.size() ? std::optional{from} : std::nullopt;
  };
  if (const auto than = find(0, {"than", "outweigh", "outweighs"})) return than;
  const auto names = [&](const Token& token) { return lexicon.names_something(token.text); };
  const auto is_valued = [](const Token& token) { return speaks_of_value(token.text); };
  if (const auto either = find(0, {"or"}); either && std::any_of(tokens.begin(), tokens.end(), is_valued))
    return either;
  const auto prefer = find(0, {"prefer", "prefers", "preferring"});
  for (auto i = prefer; i;) {
    i = find(*i + 1, {"to", "over"});
    if (!i) return std::nullopt;
    const auto middle = tokens.begin() + static_cast<std::ptrdiff_t>(*i);
    const bool is_between = std::any_of(tokens.begin() + static_cast<std::ptrdiff_t>(*prefer), middle, names) &&
                            std::any_of(middle, tokens.end(), names);
    if (is_between) return i;
  }
  return std::nullopt;
}

// How often, as a fraction.
struct Amount {
  std::int64_t n = 1, of = 1;
};

// One side: how often each feature, in parts, and what its words do. Every word counts, or is refused.
class Side {
 public:
  Side(const Domain& domain, const Lexicon& lexicon, const std::string& text, std::span<const Token> tokens)
      : domain_{domain}, lexicon_{lexicon}, text_{text}, counts_(domain.num_features()) {
    for (std::size_t i = 0; i < tokens.size(); ++i) i += take(tokens[i], tokens.subspan(i + 1));
    close();
  }

  [[nodiscard]] const IntegerVector& counts() const { return counts_; }
  [[nodiscard]] std::int64_t parts() const { return parts_; }
  [[nodiscard]] bool has_action() const { return has_action_; }
  [[nodiscard]] std::optional<Place> says(Role role) const {
    const auto at = said_.find(role);
    return at == said_.end() ? std::nullopt : std::optional{at->second};
  }
  [[nodiscard]] const std::map<Role, Place>& said() const { return said_; }
  // Whether its last word that counts is "more" or "less".
  [[nodiscard]] bool ends_in_degree() const { return last_ == Role::kMore || last_ == Role::kLess; }
  // 1 if all of it is a gain to the robot, -1 if all of it is a cost, else 0.
  [[nodiscard]] int sign() const {
    int sign = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      const auto weight = domain_.weights().integer[k];
      if (counts_[k] == 0) continue;
      if (weight == 0 || (sign != 0 && (sign > 0) != (weight > 0))) return 0;
      sign = weight < 0 ? -1 : 1;
    }
    return sign;
  }

 private:
  [[noreturn]] void refuse(const Token& token, const std::string& id, const std::string& message) const {
    fail(text_, token.place, id, message,
         "compare two things that the robot may do: is ... worse than 2 ..., would it rather ... than ...");
  }

  // How many of the following tokens are read with it.
  std::size_t take(const Token& token, std::span<const Token> next) {
    const auto& word = token.text;
    const bool has_next = !next.empty();
    if (const auto amount = amount_of(token)) {
      const bool is_times = has_next && is_one_of(next.front(), {"time", "times"});
      const bool follows = last_ == Role::kNone && (is_times || word == "twice" || word == "once");
      if (amount_ || (!phrase_.empty() && !follows))
        refuse(token, "E1106", "it is not clear what '" + word + "' counts");
      amount_ = amount;
      number_ = token;
      return is_times || (has_next && is_one_of(next.front(), {"more", "extra", "additional", "another"})) ? 1 : 0;
    }
    if (token.kind != Token::Kind::kWord) refuse(token, "E1103", "a comparison does not take '" + word + "'");
    if (word == "and" || word == "plus") {
      close();
      return 0;
    }
    if (denies(word)) refuse(token, "E1106", "a comparison with '" + word + "' could mean the opposite");
    if (word == "or") refuse(token, "E1106", "two things at a time are compared");
    const auto role = role_of(token);
    const bool names = lexicon_.knows(word);
    if (role != Role::kNone && !(names && lexicon_.names_something(word))) {
      if (!said_.emplace(role, token.place).second) refuse(token, "E1106", "'" + word + "' is said twice");
      last_ = role;
    } else if (names) {
      if (phrase_.empty()) place_ = token.place;
      place_.length = token.place.column + token.place.length - place_.column;
      phrase_.push_back(word);
      if (!lexicon_.says_only_contact(word)) last_ = Role::kNone;
    } else if (!is_filler(word) && !is_one_of(token, {"true"})) {
      fail_unknown(lexicon_, text_, word, token.place, lexicon_.all_words());
    }
    return 0;
  }

  [[nodiscard]] std::optional<Amount> amount_of(const Token& token) const {
    constexpr std::size_t kMost = 1'000'000;
    const auto counted = [&](std::size_t n, std::size_t of) {
      if (n > kMost || of == 0) refuse(token, "E1103", "a comparison takes numbers up to 1,000,000");
      return Amount{static_cast<std::int64_t>(n), static_cast<std::int64_t>(of)};
    };
    if (token.kind == Token::Kind::kNumber) return counted(token.number, 1);
    if (token.kind == Token::Kind::kFraction) return counted(token.number, token.row);
    if (token.kind != Token::Kind::kWord) return std::nullopt;
    static const std::map<std::string, Amount> kWords{
        {"half", {1, 2}}, {"once", {}},    {"twice", {2, 1}}, {"two", {2, 1}},   {"three", {3, 1}}, {"four", {4, 1}},
        {"five", {5, 1}}, {"six", {6, 1}}, {"seven", {7, 1}}, {"eight", {8, 1}}, {"nine", {9, 1}},  {"ten", {10, 1}}};
    const auto at = kWords.find(token.text);
    return at == kWords.end() ? std::nullopt : std::optional{at->second};
  }

  void close() {
    std::erase_if(phrase_, [&](const std::string& word) { return lexicon_.says_only_contact(word); });
    if (phrase_.empty() && amount_) refuse(number_, "E1106", "it is not clear what '" + number_.text + "' counts");
    if (phrase_.empty()) return;
    const auto found = lexicon_.happenings(phrase_);
    if (found.size() != 1) {
      std::string said;
      for (const auto& word : phrase_) said += (said.empty() ? "" : " ") + word;
      fail(text_, place_, "E1103", "'" + said + "' is not one of what this robot's reward counts",
           "use the name of a feature");
    }
    if (found.front().action) {
      has_action_ = true;
    } else {
      const auto amount = amount_.value_or(Amount{});
      const auto common = std::lcm(parts_, amount.of);
      for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] *= common / parts_;
      counts_[found.front().feature] += amount.n * (common / amount.of);
      parts_ = common;
    }
    phrase_.clear();
    amount_.reset();
  }

  const Domain& domain_;
  const Lexicon& lexicon_;
  const std::string& text_;
  IntegerVector counts_;
  std::int64_t parts_ = 1;
  std::map<Role, Place> said_;
  Role last_ = Role::kNone;
  std::vector<std::string> phrase_;
  Place place_;
  std::optional<Amount> amount_;
  Token number_;
  bool has_action_ = false;
};

// "cost anything", "is worth something".
bool asks_for_anything(const std::vector<Token>& tokens) {
  const auto says = [&](std::initializer_list<Role> any) {
    return std::any_of(tokens.begin(), tokens.end(), [&](const Token& token) {
      return std::find(any.begin(), any.end(), role_of(token)) != any.end();
    });
  };
  return says({Role::kSomething, Role::kNothing}) && std::any_of(tokens.begin(), tokens.end(), [](const Token& token) {
           return is_one_of(token, {"cost", "costs", "worth"});
         });
}

// How a comparison counts its sides: first * left - second * right >= 0.
struct Signs {
  int first = 0, second = 0;
};

// What the words of both sides say together; nothing if they say it in no way that is clear.
std::optional<Signs> signs_of(const Side& left, const Side& right, const Token& between) {
  auto said = left.said();
  said.erase(Role::kMore);
  said.erase(Role::kLess);
  std::set<Role> behind;
  for (const auto& [role, place] : right.said()) behind.insert(role);
  const bool more = left.says(Role::kMore).has_value() || (between.text == "or" && behind.erase(Role::kMore) > 0);
  const bool less = left.says(Role::kLess).has_value() || (between.text == "or" && behind.erase(Role::kLess) > 0);
  const int degree = less ? -1 : 1;
  if (more && less) return std::nullopt;
  const auto only = [&](std::initializer_list<Role> roles) {
    return said.size() == roles.size() &&
           std::all_of(roles.begin(), roles.end(), [&](Role role) { return said.contains(role); });
  };
  if (between.text == "or" && said.empty()) {  // "does rubble or smoke cost more"
    for (const Role role : behind) said.emplace(role, Place{});
    behind.clear();
  }
  if (between.text.starts_with("outweigh") ? said.empty() && !more && !less : only({Role::kWeighs}) && more != less) {
    const Signs signs{left.sign() * degree, right.sign() * degree};
    return signs.first != 0 && signs.second != 0 && behind.empty() ? std::optional{signs} : std::nullopt;
  }
  const bool compares_weights = only({Role::kWorse}) || only({Role::kBetter}) || only({Role::kBetter, Role::kGain});
  if (compares_weights && behind.empty()) {
    const int sign = said.contains(Role::kWorse) ? -degree : degree;
    return Signs{sign, sign};
  }
  if (only({Role::kRather}) && behind.empty() && !more && !less) return Signs{1, 1};
  const int first = only({Role::kCost}) ? -1 : only({Role::kGain}) ? 1 : 0;
  if (first == 0 || more == less || (between.text == "than" && !left.ends_in_degree())) return std::nullopt;
  if (between.text == "or") return behind.empty() ? std::optional{Signs{first * degree, first * degree}} : std::nullopt;
  const bool is_cost = behind.erase(Role::kCost) > 0, is_gain = behind.erase(Role::kGain) > 0;
  const int second = is_cost == is_gain ? right.sign() : (is_gain ? 1 : -1);
  if (!behind.empty() || (is_cost && is_gain) || second == 0) return std::nullopt;
  return Signs{first * degree, second * degree};
}

}  // namespace

bool compares(const Lexicon& lexicon, const std::vector<Token>& tokens) {
  return separator(lexicon, tokens).has_value() || asks_for_anything(tokens);
}

std::optional<HalfSpace> read_comparison(const Domain& domain, const Lexicon& lexicon, const std::string& text,
                                         const std::vector<Token>& tokens) {
  const auto at = separator(lexicon, tokens).value_or(tokens.size());
  const bool is_alone = at == tokens.size();
  const std::span<const Token> all{tokens};
  const Side left{domain, lexicon, text, all.first(at)};
  const Side right{domain, lexicon, text, all.subspan(is_alone ? at : at + 1)};
  if (left.has_action() || right.has_action()) return std::nullopt;
  const Place whole{1, std::max<std::size_t>(text.size(), 1)};
  const auto unclear = [&](const std::string& message) {
    fail(text, whole, "E1106", message,
         "for instance: is FEATURE worse than 2 steps, does FEATURE cost more than a step");
  };
  if (left.counts().is_zero() || (right.counts().is_zero() && !is_alone)) unclear("what is compared with what?");
  std::optional<Signs> signs;
  if (is_alone) {
    const bool is_cost = left.says(Role::kCost).has_value(), is_gain = left.says(Role::kGain).has_value();
    const bool is_clear = is_cost != is_gain && left.said().size() == 2;
    if (is_clear) signs = Signs{is_cost == left.says(Role::kNothing).has_value() ? 1 : -1, 0};
  } else {
    signs = signs_of(left, right, tokens[at]);
  }
  if (!signs) unclear("it is not clear what is compared: say 'costs more than', 'is worth less than', 'worse than'");
  IntegerVector difference(domain.num_features());
  for (std::size_t k = 0; k < difference.size(); ++k) {
    difference[k] = signs->first * left.counts()[k] * right.parts() - signs->second * right.counts()[k] * left.parts();
  }
  if (difference.is_zero()) unclear("both sides of the comparison are the same");
  return HalfSpace{difference};
}

}  // namespace kith::detail
