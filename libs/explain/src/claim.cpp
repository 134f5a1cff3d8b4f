// "Is rubble worse than two steps?" as an inequality of reward weights.
//
//   claim    := "rather" things ("than" | "or") things
//             | [degree] side "or" side [degree]
//             | side ("more than" | "less than" | "better than" | "worse than" | "outweighs") side
//             | side ("something" | "nothing")
//   degree   := "worse" | "better" | VERB ("more" | "less")
//   side     := [VERB] things [VERB] {"plus what" things VERB}   |   "the cost of" things {"and the gain of" things}
//   things   := thing {"and" thing}
//   thing    := a name as in_words() prints it | [NUMBER] NAME {NAME} [NUMBER "times"]
//
// Costs are the negative of weights: things count -1 where they "cost", and 1 where they "are worth" something. Without
// a verb they count as what they are to the robot.
#include <algorithm>
#include <numeric>
#include <set>

#include "kith/explain/words.hpp"
#include "question_reader.hpp"

namespace kith::detail {
namespace {

using enum Meaning;

// So many of each feature, in parts.
struct Amounts {
  IntegerVector counts;
  std::int64_t parts = 1;
  int sign = 0;  // how they count, if that is said
};

class ClaimReader {
 public:
  explicit ClaimReader(Reader& reader) : reader_{reader}, domain_{reader.domain()} {}

  HalfSpace claim() {
    takes(kWhat, kWhich);
    const auto rather = reader_.take(one_of(kRather));
    stops_ = rather && rather->text.starts_with("prefer") ? one_of(kTo) : 0;
    if (rather) {
      const auto left = things();
      if (!takes(kThan, kOr) && (stops_ == 0 || !takes(kTo))) unclear();
      return difference(left, 1, things(), 1);
    }
    auto degree = take_degree();
    const auto left = side();
    if (takes(kOr)) {
      const auto right = side();
      if (!degree) degree = right.sign != 0 ? take_degree_of(right.sign) : take_degree();
      if (!degree) unclear();
      return difference(left, *degree, right, *degree);
    }
    if (degree) unclear();
    return related(left);
  }

 private:
  template <typename... Some>
  bool takes(Some... some) {
    return reader_.takes(one_of(some...));
  }
  [[noreturn]] void unclear() const {
    reader_.refuse_what_is_left();
    reader_.fail_at(reader_.whole(), "E1106", "it is not clear what is compared with what",
                    "for instance: is FEATURE worse than 2 steps, does FEATURE cost more than a step");
  }

  // "worse", "costs more": how both sides count.
  std::optional<int> take_degree() {
    if (takes(kWorse)) return -1;
    if (takes(kBetter)) return 1;
    const auto begin = reader_.at();
    if (const int verb = take_verb(); verb != 0) {
      if (const auto degree = take_degree_of(verb)) return degree;
    }
    reader_.go_to(begin);
    return std::nullopt;
  }
  std::optional<int> take_degree_of(int verb) {
    if (takes(kMore)) return verb;
    if (takes(kLess)) return -verb;
    return std::nullopt;
  }
  int take_verb() { return takes(kCost) ? -1 : takes(kGain) ? 1 : 0; }

  HalfSpace related(const Amounts& left) {
    if (left.sign != 0 && reader_.sees(one_of(kSomething, kNothing))) {
      const int sign = takes(kNothing) ? -left.sign : left.sign;
      takes(kSomething);
      return difference(left, sign, Amounts{IntegerVector(domain_.num_features())}, 1);
    }
    for (const auto& [word, sign] : {std::pair{kBetterThan, 1}, std::pair{kWorseThan, -1}}) {
      if (left.sign >= 0 && takes(word)) return difference(left, sign, things(), sign);
    }
    const bool outweighs = takes(kOutweigh);
    const int sign = outweighs || takes(kMoreThan) ? 1 : takes(kLessThan) ? -1 : 0;
    const int first = outweighs ? how_it_counts(left, 0) : left.sign;
    if (sign == 0 || first == 0) unclear();
    const auto right = side(left.sign);
    const int second = how_it_counts(right, left.sign);
    if (second == 0) unclear();
    return difference(left, sign * first, right, sign * second);
  }

  [[nodiscard]] HalfSpace difference(const Amounts& left, int first, const Amounts& right, int second) const {
    IntegerVector normal(domain_.num_features());
    for (std::size_t k = 0; k < normal.size(); ++k)
      normal[k] = first * left.counts[k] * right.parts - second * right.counts[k] * left.parts;
    if (!normal.is_zero()) return HalfSpace{normal};
    reader_.fail_at(reader_.whole(), "E1106", "both sides of the comparison are the same",
                    "compare two things that differ");
  }

  // 1 if to the robot all of it is a gain, -1 if all of it is a cost.
  [[nodiscard]] int how_it_counts(const Amounts& amounts, int otherwise) const {
    if (amounts.sign != 0) return amounts.sign;
    bool gains = false, costs = false;
    for (std::size_t k = 0; k < amounts.counts.size(); ++k) {
      const auto count = amounts.counts[k], weight = domain_.weights().integer[k];
      if (count == 0 || weight == 0) continue;
      ((count > 0) == (weight > 0) ? gains : costs) = true;
    }
    return gains == costs ? otherwise : gains ? 1 : -1;
  }

  // Without a verb a side counts as what it is to the robot, or else like the other one.
  Amounts side(int other = 0) {
    Amounts total{IntegerVector(domain_.num_features())};
    if (reader_.sees(one_of(kCostOf, kGainOf))) {
      do {
        const int sign = takes(kCostOf) ? -1 : takes(kGainOf) ? 1 : 0;
        add(total, things(), sign);
      } while (takes(kAnd));
      return total;
    }
    const int before = take_verb();
    total = things();
    total.sign = takes(kMatter) ? how_it_counts(total, 0) : take_verb();
    if (before != 0 && total.sign != 0) unclear();
    total.sign += before;
    if (reader_.sees(one_of(kPlusWhat))) total.sign = how_it_counts(total, other);
    while (takes(kPlusWhat)) {
      const auto more = things();
      add(total, more, take_verb());
    }
    return total;
  }

  // Adds what counts with a sign of its own.
  void add(Amounts& total, const Amounts& more, int sign) const {
    if (sign == 0) unclear();
    constexpr std::int64_t kMostParts = 100'000;
    const auto common = std::lcm(total.parts, more.parts);
    if (common > kMostParts)
      reader_.fail_at(reader_.whole(), "E1103", "these fractions have no small common denominator",
                      "write smaller ones");
    const auto own = total.sign == 0 ? 1 : total.sign;
    for (std::size_t k = 0; k < total.counts.size(); ++k)
      total.counts[k] = own * total.counts[k] * (common / total.parts) + sign * more.counts[k] * (common / more.parts);
    total.parts = common;
    total.sign = 1;
  }

  Amounts things() {
    auto all = thing();
    for (auto begin = reader_.at();; begin = reader_.at()) {
      if (takes(kAnd) && !reader_.sees(one_of(kCostOf, kGainOf))) {
        add(all, thing(), 1);
        continue;
      }
      reader_.go_to(begin);
      const bool is_in_list = begin < reader_.tokens().size() && reader_.tokens()[begin].kind == Token::Kind::kComma;
      const auto next = is_in_list ? take_printed() : std::nullopt;  // "a, b and c"
      if (!next) break;
      add(all, *next, 1);
    }
    all.sign = 0;
    return all;
  }

  Amounts thing() {
    if (auto printed = take_printed()) return *printed;
    auto amount = take_amount();
    if (amount) takes(kMore);
    std::vector<Token> words;
    while (const auto name = reader_.take_name(words.empty() ? 0 : stops_)) words.push_back(*name);
    std::erase_if(words, [&](const Token& word) { return reader_.lexicon().says_only_contact(word.text); });
    if (words.empty()) unclear();
    const auto found = reader_.lexicon().happenings(texts_of(words));
    if (found.size() != 1 || found.front().action) {
      reader_.fail_at(place_of(words), "E1103", "'" + phrase(words) + "' is not one of what this robot's reward counts",
                      "its features are " + listed(domain_.feature_names()));
    }
    if (!amount) amount = take_times();
    Amounts one{IntegerVector(domain_.num_features())};
    one.counts[found.front().feature] = amount ? static_cast<std::int64_t>(amount->number) : 1;
    one.parts = amount ? static_cast<std::int64_t>(amount->row) : 1;
    return one;
  }

  // Half, twice, 2, 1.5: a fraction.
  std::optional<Token> take_amount() {
    constexpr std::size_t kMost = 1'000'000;
    static const std::vector<std::string> kFrom3 = words_that_mean(kCount);
    auto amount = reader_.take_number();
    if (amount && amount->kind == Token::Kind::kNumber) amount->row = 1;
    if (amount && amount->number > kMost)
      reader_.fail_at(amount->place, "E1103", "a comparison takes numbers up to 1,000,000", "write a smaller number");
    if (amount) return amount;
    amount = reader_.take(one_of(kHalf, kOnce, kTwice, kCount));
    if (!amount) return amount;
    const auto at = std::find(kFrom3.begin(), kFrom3.end(), amount->text);
    amount->number = at != kFrom3.end()                ? static_cast<std::size_t>(at - kFrom3.begin()) + 3
                     : means(amount->meanings, kTwice) ? 2
                                                       : 1;
    amount->row = means(amount->meanings, kHalf) ? 2 : 1;
    return amount;
  }

  // "twice", "3 times": behind what is counted.
  std::optional<Token> take_times() {
    const auto begin = reader_.at();
    const auto amount = take_amount();
    if (amount && (amount->text == "once" || amount->text == "twice" || takes(kTimes))) return amount;
    reader_.go_to(begin);
    return std::nullopt;
  }

  // The longest name of so many of a feature, as kith prints it: "crossing rubble twice", "2 fewer steps".
  std::optional<Amounts> take_printed() {
    const auto& tokens = reader_.tokens();
    std::set<std::int64_t> numbers{1, 2};
    for (auto i = reader_.at(); i < tokens.size(); ++i) {
      if (tokens[i].kind == Token::Kind::kNumber) numbers.insert(static_cast<std::int64_t>(tokens[i].number));
    }
    std::optional<Amounts> best;
    std::size_t end = 0;
    for (auto begin = reader_.at(); begin <= reader_.next() && !best; ++begin) {
      for (std::size_t k = 0; k < domain_.num_features(); ++k) {
        for (const auto n : numbers) {
          for (const bool is_fewer : {false, true}) {
            const auto name =
                with_phrases(tokens_of(is_fewer ? times_fewer(domain_.wording(k), n) : times(domain_.wording(k), n)));
            const bool fits = begin + name.size() > std::max(end, begin) && begin + name.size() <= tokens.size() &&
                              std::equal(name.begin(), name.end(), tokens.begin() + static_cast<std::ptrdiff_t>(begin),
                                         [](const Token& a, const Token& b) { return a.text == b.text; });
            if (!fits) continue;
            end = begin + name.size();
            best = Amounts{IntegerVector(domain_.num_features())};
            best->counts[k] = is_fewer ? -n : n;
          }
        }
      }
    }
    if (best) reader_.go_to(end);
    return best;
  }

  Reader& reader_;
  const Domain& domain_;
  Meanings stops_ = 0;
};

}  // namespace

bool sees_claim(const Reader& reader) {
  Meanings all = 0;
  bool separates = false, names = false, prefers = false;
  for (auto i = reader.at(); i < reader.tokens().size(); ++i) {
    const auto& token = reader.tokens()[i];
    const bool is_between = (token.meanings & one_of(kThan, kOr, kTo)) != 0;
    separates = separates || (prefers && names && is_between);
    names = names || token.kind == Token::Kind::kName;
    prefers = prefers || means(token.meanings, kRather);
    all |= token.meanings;
  }
  const auto says = [&](auto... some) { return (all & one_of(some...)) != 0; };
  return separates || says(kMoreThan, kLessThan, kWorseThan, kBetterThan, kOutweigh) ||
         (says(kOr) && says(kCost, kGain, kWorse, kBetter)) || (says(kSomething, kNothing) && says(kCost, kGain));
}

HalfSpace read_claim(Reader& reader) { return ClaimReader{reader}.claim(); }

}  // namespace kith::detail
