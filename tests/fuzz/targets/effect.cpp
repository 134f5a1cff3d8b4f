// Effects to plan for, formulas of models and conditions on rows, as given on the command line, one a line. What is
// read is written in a form that reads as the same.

#include "kith/planning/effect.hpp"
#include <set>

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/analysis/dataset.hpp"
#include "kith/stats/formula.hpp"

using namespace kith;

namespace {

void check_effect(std::string_view text, const StudySpec& spec) {
  const auto reading = parse_effect(text, spec);
  if (!reading.effect) return fuzzing::require(!reading.problem.empty(), "no effect without a reason");
  const auto written = to_string(*reading.effect);
  const auto again = parse_effect(written, spec);
  fuzzing::require(again.effect && to_string(*again.effect) == written, "an effect reads as written", written);
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

void check_formula(std::string_view text) {
  const auto reading = parse_formula(text);
  for (const auto& error : reading.errors) {
    fuzzing::require(!error.message.empty() && error.column >= 1 && error.column <= text.size() + 1,
                     "an error of a formula says what and where", error.message);
  }
  if (!reading.errors.empty()) return;
  const auto written = to_string(reading.formula);
  const auto again = parse_formula(written);
  fuzzing::require(again.errors.empty() && again.formula.response == reading.formula.response &&
                       named_terms(again.formula) == named_terms(reading.formula),
                   "a formula reads as written", written);
}

void check_filter(std::string_view text) {
  fuzzing::reads(text, "filter", [&] {
    const auto filter = parse_row_filter(text);
    fuzzing::require(!filter.column.empty(), "a condition is on a column");
    fuzzing::require(filter.column + (filter.equal ? "=" : "!=") + filter.value == text, "nothing of it is lost");
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kSpec = fuzzing::tiny_study().study.value().variants.front();
  fuzzing::Bytes bytes{data, size};
  check_effect(bytes.line(), kSpec);
  check_formula(bytes.line());
  check_filter(bytes.line());
  return 0;
}
