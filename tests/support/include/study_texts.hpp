#pragma once

#include <string>

namespace kith::testing {

/// The learner types N (novice) and P (proficient) of a study file, as in studies/paper-uncalibrated.toml.
inline const std::string kPaperLearners = R"([learner.N]
ability = { mean = 0.703, sd = 0.034 }
confirm_gain = { half_normal = 0.033 }
correct_gain = { half_normal = 0.056 }
[learner.P]
ability = { mean = 0.809, sd = 0.025 }
confirm_gain = { half_normal = 0.022 }
correct_gain = { half_normal = 0.052 }
)";

}  // namespace kith::testing
