// Effects to plan for and conditions on rows, as given on the command line, one a line. What is
// read is written in a form that reads as the same.

#include "kith/analysis/effect.hpp"

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/analysis/dataset.hpp"

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

bool check_filter(std::string_view text) {
  const auto outcome = fuzzing::reads(text, "filter", [&] {
    const auto filter = parse_row_filter(text);
    fuzzing::require(!filter.column.empty(), "a condition is on a column");
    fuzzing::require(filter.column + (filter.equal ? "=" : "!=") + filter.value == text, "nothing of it is lost");
  });
  return outcome == fuzzing::Outcome::kRead;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "effect"};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  static const auto kSpec = fuzzing::tiny_study().study.value().variants.front();
  fuzzing::Bytes bytes{input};
  const bool effect = check_effect(bytes.line(), kSpec);
  const bool filter = check_filter(bytes.line());
  if (effect && filter) return Outcome::kRead;
  return effect || filter ? Outcome::kRefused : Outcome::kMalformed;
}
