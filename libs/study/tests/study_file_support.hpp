#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "kith/study/study_file.hpp"

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

}  // namespace kith::testing
