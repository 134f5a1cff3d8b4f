// Effects to plan for, formulas of models and conditions on rows, as given on the command line, one a line. What is
// read is written in a form that reads as the same.

#include "kith/study_design/effect.hpp"
#include <set>

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/analysis/dataset.hpp"
#include "kith/stats/formula.hpp"

using namespace kith;

namespace {

// Each returns whether the text was understood.

bool check_effect(std::string_view text, const StudySpec& spec) {
  const auto reading = parse_effect(text, spec);
  fuzzing::require(reading.effect || !reading.problem.empty(), "no effect without a reason");
  if (!reading.effect) return false;
  const auto written = to_string(*reading.effect);
  const auto again = parse_effect(written, spec);
  fuzzing::require(again.effect && to_string(*again.effect) == written, "an effect reads as written", written);
  return true;
}

std::set<std::set<std::string>> named_terms(const Formula& formula) {
  std::set<std::set<std::string>> terms;
  for (const auto& term : formula.terms) {
    std::set<std::string> names;
    for (const auto factor : term) names.insert(formula.factors[factor]);
    terms.insert(names);
  }
  return terms;
}

bool check_formula(std::string_view text) {
  const auto reading = parse_formula(text);
  for (const auto& error : reading.errors) {
    fuzzing::require(!error.message.empty() && error.column >= 1 && error.column <= text.size() + 1,
                     "an error of a formula says what and where", error.message);
  }
  if (!reading.errors.empty()) return false;
  const auto written = to_string(reading.formula);
  const auto again = parse_formula(written);
  fuzzing::require(again.errors.empty() && again.formula.response == reading.formula.response &&
                       named_terms(again.formula) == named_terms(reading.formula) &&
                       again.formula.random_intercepts == reading.formula.random_intercepts,
                   "a formula reads as written", written);
  return true;
}

bool check_filter(std::string_view text) {
  const auto outcome = fuzzing::reads(text, "filter", [&] {
    const auto filter = parse_row_filter(text);
    fuzzing::require(!filter.column.empty(), "a condition is on a column");
    fuzzing::require(filter.column + (filter.equal ? "=" : "!=") + filter.value == text, "nothing of it is lost");
  });
  return outcome == fuzzing::Outcome::kRead;
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"effect"};
  return mutate_lines(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_lines(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kSpec = fuzzing::tiny_study().study.value().variants.front();
  fuzzing::Bytes bytes{data, size};
  const bool effect = check_effect(bytes.line(), kSpec);
  const bool formula = check_formula(bytes.line());
  const bool filter = check_filter(bytes.line());
  using fuzzing::Outcome;
  const bool all = effect && formula && filter;
  const bool some = effect || formula || filter;
  fuzzing::note({reinterpret_cast<const char*>(data), size}, all    ? Outcome::kRead
                                                             : some ? Outcome::kRefused
                                                                    : Outcome::kMalformed);
  return 0;
}
