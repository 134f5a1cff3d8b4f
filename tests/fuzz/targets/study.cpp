// Study files. What is read can be written with every key, and that reads as the same study.

#include "kith/study/study.hpp"
#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/domains/domain_file.hpp"

using namespace kith;

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"study"};
  return mutate_text(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_text(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  for (const auto& domain : built_in_domains()) {
    if (text.find(domain.name) != std::string_view::npos) return 0;  // takes too long
  }
  const StudyReadOptions options{.folder = fuzzing::folder()};
  const auto reading = parse_study(text, "study.toml", options);
  fuzzing::require(reading.study.has_value() != has_errors(reading.diagnostics), "a study, or errors");
  fuzzing::require_good(reading.diagnostics, text, "study.toml");
  fuzzing::note(text, fuzzing::outcome_of(reading.diagnostics));
  if (!reading.study) return 0;
  fuzzing::require(num_teams(*reading.study) > 0, "a study has teams");
  const auto written = to_toml(*reading.study, *reading.domain);
  const auto again = parse_study(written, "written.toml", options);
  fuzzing::require(again.study.has_value(), "what is written can be read", written);
  fuzzing::require(to_toml(*again.study, *again.domain) == written, "writing is a fixpoint", written);
  fuzzing::require(num_teams(*again.study) == num_teams(*reading.study), "the teams are the same");
  return 0;
}
