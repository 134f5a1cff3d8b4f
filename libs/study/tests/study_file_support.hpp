#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "kith/study/study_file.hpp"
#include "study_texts.hpp"

namespace kith::testing {

inline constexpr const char* kStudy = R"(schema = "kith.study/1"
id = "tiny"
domain = "item-delivery"
seed = 7
replicates = 2
[design]
strategies = ["common", "baseline"]
compositions = ["NN", "N"]
[learner.N]
ability = { mean = 0.7, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
)";

/// The study with one piece of its text replaced.
[[nodiscard]] inline std::string study_with(const std::string& old, const std::string& replacement) {
  std::string text = kStudy;
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error{"the study does not contain " + old};
  return text.replace(at, old.size(), replacement);
}

[[nodiscard]] inline std::vector<std::string> ids(const StudyReading& reading) {
  std::vector<std::string> result;
  for (const auto& diagnostic : reading.diagnostics) result.push_back(diagnostic.id);
  return result;
}

[[nodiscard]] inline StudyReading parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_study(text, "study.toml", {overrides, {}});
}

/// Teams of the paper's people, all of them learning by one model.
[[nodiscard]] inline Study study_of_kind(const LearnerModel& model, const std::string& compositions,
                                         std::size_t replicates, std::uint64_t seed, const std::string& settings) {
  auto study = parse_study("schema = \"kith.study/1\"\nid = \"judged\"\ndomain = \"item-delivery\"\nseed = " +
                               std::to_string(seed) + "\nreplicates = " + std::to_string(replicates) +
                               "\n[design]\nstrategies = [\"joint\"]\ncompositions = " + compositions + "\n" +
                               kPaperLearners + settings,
                           "judged.toml")
                   .study.value();
  for (auto& type : study.variants.front().learner_types) type.model = &model;
  return study;
}

}  // namespace kith::testing
