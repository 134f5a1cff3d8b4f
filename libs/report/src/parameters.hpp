#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "run_files.hpp"

namespace kith::detail {

// What a key of a resolved study means, in words: "learner.N.ability.sd" -> "standard deviation of the initial
// ability"; nothing for a key that is not known. Parameters of learners are those of `model`, of stop rules those of
// `teaching`.
[[nodiscard]] std::optional<std::string> meaning_of(std::string_view key, const LearnerModel& model = bayesian_model(),
                                                    const TeachingOptions& teaching = {});

// Every parameter of the run, resolved: columns group, key, value, meaning.
[[nodiscard]] Json parameters_table(const RunFiles& run);

// The shortest text that reads back to the same number: "0.703".
[[nodiscard]] std::string shortest(double value);

}  // namespace kith::detail
