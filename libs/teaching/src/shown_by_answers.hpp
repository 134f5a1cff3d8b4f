#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "kith/teaching/lesson.hpp"

namespace kith {

// Adds what is not there yet: a constraint that several test sets examine is shown once.
inline void add_new(std::vector<HalfSpace>& shown, std::span<const HalfSpace> more) {
  for (const auto& half_space : more) {
    if (std::find(shown.begin(), shown.end(), half_space) == shown.end()) shown.push_back(half_space);
  }
}

// What answers show, each half-space once.
[[nodiscard]] inline std::vector<HalfSpace> shown_by(std::span<const Verdict> verdicts) {
  std::vector<HalfSpace> shown;
  for (const auto& verdict : verdicts) add_new(shown, verdict.half_spaces);
  return shown;
}

// What revised answers show that the first ones did not: answers that were kept show nothing a second time.
[[nodiscard]] inline std::vector<HalfSpace> shown_by_revision(std::span<const Verdict> first,
                                                              std::span<const Verdict> revised) {
  const auto before = shown_by(first);
  auto shown = shown_by(revised);
  std::erase_if(shown,
                [&](const HalfSpace& one) { return std::find(before.begin(), before.end(), one) != before.end(); });
  return shown;
}

}  // namespace kith
