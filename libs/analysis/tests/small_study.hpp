#pragma once

#include <string>
#include <vector>

#include "kith/study/study_file.hpp"

namespace kith::testing {

/// Two novices, two strategies, small beliefs: a team takes a fraction of a millisecond.
[[nodiscard]] inline StudyReading small_study(const std::vector<std::string>& overrides) {
  constexpr const char* kText = R"(schema = "kith.study/1"
id = "small"
domain = "item-delivery"
seed = 7
replicates = 3
[design]
strategies = ["baseline", "common"]
compositions = ["NN"]
[learner.N]
ability = { mean = 0.75, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { half_normal = 0.05 }
particles = 200
[teacher]
particles = 200
[stop]
max_periods = 30
)";
  return parse_study(kText, "small.toml", {overrides, {}});
}

}  // namespace kith::testing
