#include "kith/teaching/observed_period.hpp"

#include <utility>

#include "kith/bec/comparison.hpp"
#include "kith/domains/judgement.hpp"

namespace kith {

Verdict verdict_on(const Atlas& atlas, const Test& test, const Answer& answer) {
  Verdict verdict;
  verdict.answered = answer.has_value();
  if (!answer) return verdict;
  const auto judged = judge_path(atlas.domain(), atlas.feature_counts(test.start), *answer);
  verdict.correct = judged.is_right;
  verdict.regret = judged.regret;
  auto preferred = preference(-judged.loss, atlas.domain().count_scale());  // of the answer to the robot's path
  if (verdict.correct) {
    // Another path that is as good shows no preference between the two, and nothing about others.
    if (!preferred) verdict.half_spaces = test.covered;
  } else if (preferred) {
    verdict.half_spaces.push_back(std::move(*preferred));
  }
  return verdict;
}

ObservedPeriod exam_board(const Atlas& atlas, StartIndex start, const Answer& answer, std::size_t period) {
  const auto covered = atlas.constraints().half_spaces(atlas.tested_constraints(start).without(atlas.prior()));
  ObservedPeriod board;
  board.period = period;
  board.tests = {{.start = start, .covered = covered}};
  board.answers = {answer};
  board.verdicts = {verdict_on(atlas, board.tests.front(), answer)};
  board.all_correct = board.verdicts.front().correct;
  return board;
}

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
