#pragma once

#include <optional>
#include <span>

namespace kith {

/// The arithmetic mean. @throws std::invalid_argument without values.
[[nodiscard]] double mean(std::span<const double> values);

/// The sample standard deviation (n - 1), in two passes, so that nothing cancels; missing below two values.
[[nodiscard]] std::optional<double> standard_deviation(std::span<const double> values);

}  // namespace kith
