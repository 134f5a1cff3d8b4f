#include "kith/teaching/pace.hpp"

#include "kith/teaching/past_periods.hpp"

namespace kith {

double minutes_of(const Pace& pace, std::size_t demonstrations, std::size_t tests, bool discussed) noexcept {
  constexpr double kMinute = 60.0;
  const double test_s = pace.test_s + pace.feedback_s + (discussed ? pace.discussion_s : 0.0);
  return (static_cast<double>(demonstrations) * pace.demonstration_s + static_cast<double>(tests) * test_s) / kMinute;
}

double minutes_of(const Pace& pace, const PastPeriod& period) noexcept {
  return minutes_of(pace, period.lesson.demonstrations.size(), period.lesson.tests.size(), !period.revised.empty());
}

}  // namespace kith
