#pragma once

#include "kith/study/study_file.hpp"

namespace kith::fuzzing {

/// Study files are read in this folder: its domain tiny.toml is built a hundred times faster than item delivery.
[[nodiscard]] inline std::filesystem::path folder() { return std::filesystem::path{KITH_SOURCE_DIR} / "tests/fuzz"; }

/// A study of few teams in that domain, which varies one key.
[[nodiscard]] inline StudyReading tiny_study(const std::vector<std::string>& overrides = {}) {
  constexpr const char* kText = R"(schema = "kith.study/1"
id = "tiny"
domain = "tiny.toml"
seed = 1
replicates = 2
[design]
strategies = ["baseline", "common", "joint"]
compositions = ["NN", "NP"]
vary = { "teacher.process_noise" = [0.1, 0.5] }
[learner.N]
ability = { mean = 0.75, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
[learner.P]
ability = { mean = 0.85, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { value = 0.05 }
[record]
level = "particles"
)";
  return parse_study(kText, "tiny-study.toml", {overrides, folder()});
}

}  // namespace kith::fuzzing
