#pragma once

#include <cstddef>
#include <stdexcept>

namespace kith {

/// The share of screening tests that a person would answer correctly: the mean of the posterior distribution after
/// `right` of `tests` independent tests, with a uniform prior on that share,
///   (right + 1) / (tests + 2),
/// the rule of succession. In (0, 1); 0.5 without tests.
/// @throws std::invalid_argument if right > tests.
[[nodiscard]] inline double screening_estimate(std::size_t right, std::size_t tests) {
  if (right > tests) throw std::invalid_argument{"screening_estimate: more right answers than tests"};
  return (static_cast<double>(right) + 1.0) / (static_cast<double>(tests) + 2.0);
}

}  // namespace kith
