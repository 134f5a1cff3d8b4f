// Study files. What is read can be written with every key, and that reads as the same study.

#include "kith/study/study.hpp"
#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/domains/domain_file.hpp"

using namespace kith;

const fuzzing::Form fuzzing::kForm{.words = "study"};

fuzzing::Outcome fuzzing::run(std::string_view text) {
  for (const auto& domain : built_in_domains()) {
    if (text.find(domain.name) != std::string_view::npos) return Outcome::kRefused;  // takes too long
  }
  const StudyReadOptions options{.folder = fuzzing::folder()};
  const auto reading = parse_study(text, "study.toml", options);
  fuzzing::require(reading.study.has_value() != has_errors(reading.diagnostics), "a study, or errors");
  const auto outcome = fuzzing::require_good(reading.diagnostics, text, "study.toml");
  if (!reading.study) return outcome;
  fuzzing::require(num_teams(*reading.study) > 0, "a study has teams");
  const auto written = to_toml(*reading.study, *reading.domain);
  const auto again = parse_study(written, "written.toml", options);
  fuzzing::require(again.study.has_value(), "what is written can be read", written);
  fuzzing::require(to_toml(*again.study, *again.domain) == written, "writing is a fixpoint", written);
  fuzzing::require(num_teams(*again.study) == num_teams(*reading.study), "the teams are the same");
  return outcome;
}
