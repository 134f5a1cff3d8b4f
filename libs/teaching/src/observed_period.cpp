#include "kith/teaching/observed_period.hpp"

namespace kith {

std::vector<ObservedPeriod> observed_periods(const PastPeriods& history, std::size_t member) {
  std::vector<ObservedPeriod> periods;
  for (const auto& [lesson, answers, feedback] : history) {
    if (feedback.verdicts.at(member).empty()) continue;
    periods.push_back({.period = lesson.period,
                       .component = lesson.component,
                       .demonstrations = lesson.demonstrations,
                       .tests = lesson.tests,
                       .answers = answers[member],
                       .verdicts = feedback.verdicts[member],
                       .all_correct = feedback.all_correct[member],
                       .feedback = feedback.half_spaces});
  }
  return periods;
}

}  // namespace kith
