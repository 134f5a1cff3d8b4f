#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kith/teaching/lesson.hpp"
#include "kith/teaching/past_periods.hpp"

namespace kith {

/// What one person saw, answered and heard in an interaction period: all that can be observed of a person from outside.
struct ObservedPeriod {
  std::size_t period = 0;  ///< 1, 2, ...
  /// Index into Atlas::knowledge_components(). Nothing: a board of an exam, after all lessons, one test, which teaches
  /// nothing.
  std::optional<std::size_t> component;
  std::vector<Demonstration> demonstrations;  ///< Only `start` and `half_spaces` are read.
  std::vector<Test> tests;
  std::vector<Answer> answers;      ///< One per test; none where the person gave none.
  std::vector<Verdict> verdicts;    ///< One per test.
  bool all_correct = false;         ///< In the end, where answers were discussed.
  bool discussed = false;           ///< Whether the group talked about its answers.
  std::vector<HalfSpace> feedback;  ///< What the feedback taught; empty if the person heard none.
  [[nodiscard]] bool is_exam() const noexcept { return !component; }
  friend bool operator==(const ObservedPeriod&, const ObservedPeriod&) = default;
};

/// What an answer shows, as Session judges it. @pre the answer is not better than the robot's path.
[[nodiscard]] Verdict verdict_on(const Atlas& atlas, const Test& test, const Answer& answer);

/// A board of an exam and its answer. @param period  its number.
[[nodiscard]] ObservedPeriod exam_board(const Atlas& atlas, StartIndex start, const Answer& answer, std::size_t period);

/// What a member of a session took part in. Periods in which the member was away are left out.
[[nodiscard]] std::vector<ObservedPeriod> observed_periods(const PastPeriods& history, std::size_t member);

}  // namespace kith
