// Targets files of calibration, against a small study. What is read is in range, and every parameter can be set to both
// ends of its range.

#include <cmath>

#include "../fuzzing.hpp"
#include "../study_files.hpp"
#include "kith/study_design/targets.hpp"

using namespace kith;

namespace {

void check(const TargetSet& set) {
  for (const auto& target : set.targets) {
    fuzzing::require(std::isfinite(target.value) && target.tolerance > 0.0, "a target has a value and a tolerance");
    fuzzing::require(published_error(target) > 0.0, "a target has a standard error");
    fuzzing::require(!std::isnan(miss(target, target.value)), "no figure is off itself by an unknown distance");
  }
  for (const auto& parameter : set.parameters) {
    fuzzing::require(parameter.min < parameter.max && !parameter.keys.empty(), "a parameter has a range and keys");
    for (const double end : {parameter.min, parameter.max}) {
      const auto reading = fuzzing::tiny_study(overrides_of({parameter}, {end}));
      fuzzing::require(reading.study.has_value(), "the study takes both ends of a parameter's range", parameter.name);
    }
  }
  for (const auto& finding : set.findings) fuzzing::require(!to_string(finding.effect).empty(), "an effect has a name");
}

}  // namespace

std::string fuzzing::mutated(std::string_view input, Dice& dice) {
  static const Vocabulary kVocabulary{"targets"};
  return mutate_toml(input, kVocabulary, dice);
}

std::string fuzzing::crossed(std::string_view input, std::string_view other, Dice& dice) {
  return cross_toml(input, other, dice);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const auto make_study = [](const std::vector<std::string>& overrides) { return fuzzing::tiny_study(overrides); };
  const auto reading = parse_targets(text, "targets.toml", make_study);
  fuzzing::require(reading.targets.has_value() != has_errors(reading.diagnostics), "targets, or errors");
  fuzzing::require_good(reading.diagnostics, text, "targets.toml");
  fuzzing::note(text, fuzzing::outcome_of(reading.diagnostics));
  if (reading.targets) check(*reading.targets);
  return 0;
}
