// Reads the sentences about reward weights that in_words() makes.
#include <cctype>
#include <cstdint>
#include <string_view>

#include "comparison.hpp"
#include "kith/explain/words.hpp"

namespace kith::detail {
namespace {

std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!result.empty() && result.back() != ' ') {
      result += ' ';
    }
  }
  while (!result.empty() && (result.back() == ' ' || result.back() == '.' || result.back() == '?')) result.pop_back();
  return result;
}

// Costs are the negative of weights, so a list of things counts -1 where it "costs" and 1 where it "is worth".
class Reader {
 public:
  Reader(const Domain& domain, const std::string& text) : domain_{domain}, text_{plain(text)} {
    constexpr std::int64_t kMost = 1000;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      for (std::int64_t n = 1; n <= kMost; ++n) {
        things_.push_back({plain(times(domain.wording(k), n)), k, n});
        things_.push_back({plain(times_fewer(domain.wording(k), n)), k, -n});
      }
    }
  }

  std::optional<ReadSentence> read() {
    std::optional<HalfSpace> condition;
    if (takes("if ")) {
      condition = inequality();
      if (!condition || !takes(", ")) return std::nullopt;
    }
    const auto said = inequality();
    if (!said || at_ != text_.size()) return std::nullopt;
    return ReadSentence{*said, condition};
  }

 private:
  using Vector = std::optional<IntegerVector>;

  struct Thing {
    std::string words;
    std::size_t feature;
    std::int64_t n;
  };

  [[nodiscard]] bool sees(std::string_view what) const { return text_.compare(at_, what.size(), what) == 0; }
  bool takes(std::string_view what) {
    if (!sees(what)) return false;
    at_ += what.size();
    return true;
  }
  // One of several alternatives.
  bool takes_any(std::initializer_list<std::string_view> all) {
    for (const auto what : all) {
      if (takes(what)) return true;
    }
    return false;
  }

  // "a", "a and b", "a, b and c": the longest name counts; a comma that ends a condition is no part of it.
  Vector list() {
    IntegerVector sum(domain_.num_features());
    for (bool is_first = true;; is_first = false) {
      const auto before = at_;
      if (!is_first && !takes(" and ") && !takes(", ")) return sum;
      const Thing* best = nullptr;
      for (const auto& thing : things_) {
        if ((best == nullptr || thing.words.size() > best->words.size()) && sees(thing.words)) best = &thing;
      }
      if (best == nullptr && is_first) return std::nullopt;
      if (best == nullptr) {
        at_ = before;
        return sum;
      }
      sum[best->feature] += best->n;
      at_ += best->words.size();
    }
  }

  static Vector scaled(Vector counts, std::int64_t n) {
    if (!counts) return counts;
    for (std::size_t k = 0; k < counts->size(); ++k) (*counts)[k] *= n;
    return counts;
  }
  static Vector sum(const Vector& a, const Vector& b) { return a && b ? Vector{*a + *b} : std::nullopt; }

  std::optional<int> verb() {
    takes(" together");
    if (takes_any({" costs", " cost"})) return -1;
    if (takes_any({" is worth", " are worth"})) return 1;
    return std::nullopt;
  }

  // The verb that things take without one: "2 steps" are a cost, whatever they are compared with.
  [[nodiscard]] int own_sign(const IntegerVector& counts, int sign) const {
    bool gains = false, costs = false;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const auto weight = domain_.weights().integer[k];
      gains = gains || (counts[k] != 0 && weight > 0);
      costs = costs || (counts[k] != 0 && weight < 0);
    }
    return gains == costs ? sign : (gains ? 1 : -1);
  }

  // "2 steps", "the charger is worth", with "plus what 2 steps cost".
  Vector side(int sign) {
    auto total = list();
    if (!total) return total;
    total = scaled(total, verb().value_or(own_sign(*total, sign)));
    if (!takes(" plus what ")) return total;
    const auto more = list();
    const auto own = verb();
    return own ? sum(total, scaled(more, *own)) : std::nullopt;
  }

  // "the cost of 2 steps and the gain of stopping at the charger".
  Vector amount() {
    Vector total = IntegerVector(domain_.num_features());
    for (bool goes_on = true; goes_on; goes_on = sees(" and the ") && takes(" and ")) {
      const int sign = takes("the cost of ") ? -1 : takes("the gain of ") ? 1 : 0;
      if (sign == 0) return std::nullopt;
      total = sum(total, scaled(list(), sign));
    }
    return total;
  }

  std::optional<HalfSpace> inequality() {
    const auto difference = sees("the cost of ") || sees("the gain of ") ? of_amounts() : of_things();
    if (!difference || difference->is_zero()) return std::nullopt;
    return HalfSpace{*difference};
  }

  Vector of_amounts() {
    const auto more = amount();
    if (takes_any({" outweighs ", " outweigh "})) return sum(more, scaled(amount(), -1));
    if (!takes_any({" is ", " together are "})) return std::nullopt;
    if (takes_any({"less than nothing", "at most nothing"})) return scaled(more, -1);
    if (takes_any({"more than nothing", "at least nothing"})) return more;
    return takes_any({"no less than ", "more than "}) ? sum(more, scaled(amount(), -1)) : std::nullopt;
  }

  Vector of_things() {
    const auto first = list();
    if (takes_any({" is better than ", " are better than ", " is at least as good as ", " are at least as good as "})) {
      return sum(first, scaled(list(), -1));
    }
    const auto sign = verb();
    if (!sign) return std::nullopt;
    const auto subject = scaled(first, *sign);
    if (takes_any({" something", " nothing or more"})) return subject;
    if (takes_any({" less than nothing", " at most nothing"})) return scaled(subject, -1);
    if (takes_any({" more than ", " at least as much as "})) return sum(subject, scaled(side(*sign), -1));
    if (takes_any({" less than ", " no more than "})) return sum(scaled(subject, -1), side(*sign));
    return std::nullopt;
  }

  const Domain& domain_;
  std::string text_;
  std::vector<Thing> things_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<ReadSentence> read_sentence(const Domain& domain, const std::string& text) {
  return Reader{domain, text}.read();
}

}  // namespace kith::detail
