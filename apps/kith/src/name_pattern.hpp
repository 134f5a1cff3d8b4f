#pragma once

#include <string_view>

namespace kith::cli {

/// Whether `name` holds text that `pattern` describes: '*' stands for any text, also none, '|' separates alternatives,
/// everything else for itself. "study|bec.*plans" matches "study.one-thread" and "bec.counterfactuals-plans"; an empty
/// alternative matches every name. Takes a time that grows with the product of the lengths, at worst.
[[nodiscard]] bool matches_somewhere(std::string_view pattern, std::string_view name) noexcept;

}  // namespace kith::cli
