#include "kith/teaching/observed_period.hpp"

namespace kith {

std::vector<ObservedPeriod> observed_periods(const PastPeriods& history, std::size_t member) {
  std::vector<ObservedPeriod> periods;
  for (const auto& past : history) {
    const auto& lesson = past.lesson;
    const auto& feedback = past.feedback;
    if (feedback.verdicts.at(member).empty()) continue;
    periods.push_back({.period = lesson.period,
                       .component = lesson.component,
                       .demonstrations = lesson.demonstrations,
                       .tests = lesson.tests,
                       .answers = past.answers[member],
                       .verdicts = feedback.verdicts[member],
                       .all_correct = feedback.all_right_in_the_end(member),
                       .discussed = !past.revised.empty(),
                       .feedback = feedback.half_spaces});
  }
  return periods;
}

}  // namespace kith
