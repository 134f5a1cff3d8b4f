#pragma once

#include <vector>

#include "kith/teaching/lesson.hpp"
#include "kith/teaching/shared_list.hpp"

namespace kith {

/// A completed interaction period.
struct PastPeriod {
  Lesson lesson;
  std::vector<std::vector<Answer>> answers;  ///< Per member, per test; empty for a member who was away.
  Feedback feedback;
  std::vector<std::vector<Answer>> revised{};  ///< After a discussion, as Feedback::revised.
  friend bool operator==(const PastPeriod&, const PastPeriod&) = default;
};

/// All completed periods of a session, the first one first.
using PastPeriods = SharedList<PastPeriod>;

}  // namespace kith
