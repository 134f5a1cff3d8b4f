#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "run_files.hpp"

namespace kith::detail {

// What a key of a resolved study means, in words: "learner.N.ability.mean" -> "mean of the initial ability"; nothing
// for a key that is not known. The only list of meanings.
[[nodiscard]] std::optional<std::string_view> meaning_of(std::string_view key);

// Every parameter of the run, resolved: columns group, key, value, meaning.
[[nodiscard]] Json parameters_table(const RunFiles& run);

// The shortest text that reads back to the same number: "0.703".
[[nodiscard]] std::string shortest(double value);

}  // namespace kith::detail
