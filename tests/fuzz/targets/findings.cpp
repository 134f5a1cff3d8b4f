// The findings of targets files, against a small study.

#include "kith/analysis/findings.hpp"
#include "../fuzzing.hpp"
#include "../study_files.hpp"

using namespace kith;

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"findings"};
  return mutate_text(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_text(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  static const auto kStudy = fuzzing::tiny_study({});
  const auto reading = parse_findings(text, "targets.toml", kStudy.study->variants.front());
  fuzzing::require(reading.findings.has_value() != has_errors(reading.diagnostics), "findings, or errors");
  fuzzing::require_good(reading.diagnostics, text, "targets.toml");
  fuzzing::note(text, fuzzing::outcome_of(reading.diagnostics));
  for (const auto& finding : reading.findings.value_or(std::vector<PublishedFinding>{}))
    fuzzing::require(!to_string(finding.effect).empty(), "an effect has a name");
  return 0;
}
