// The findings of targets files, against a small study.

#include "kith/analysis/findings.hpp"
#include "../fuzzing.hpp"
#include "../study_files.hpp"

using namespace kith;

const fuzzing::Form fuzzing::kForm{.words = "findings"};

fuzzing::Outcome fuzzing::run(std::string_view text) {
  static const auto kStudy = fuzzing::tiny_study({});
  const auto reading = parse_findings(text, "targets.toml", kStudy.study->variants.front());
  fuzzing::require(reading.findings.has_value() != has_errors(reading.diagnostics), "findings, or errors");
  const auto outcome = fuzzing::require_good(reading.diagnostics, text, "targets.toml");
  for (const auto& finding : reading.findings.value_or(std::vector<PublishedFinding>{}))
    fuzzing::require(!to_string(finding.effect).empty(), "an effect has a name");
  return outcome;
}
