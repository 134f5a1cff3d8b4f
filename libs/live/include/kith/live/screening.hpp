#pragma once

#include <cstddef>

namespace kith {

/// The share of screening tests that a person would answer correctly: the mean of the posterior distribution after
/// `right` of `tests` independent tests, with a uniform prior on that share,
///   (right + 1) / (tests + 2),
/// the rule of succession. In (0, 1); 0.5 without tests.
/// @throws std::invalid_argument if right > tests.
[[nodiscard]] double screening_estimate(std::size_t right, std::size_t tests);

}  // namespace kith
