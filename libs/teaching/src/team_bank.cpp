#include "kith/teaching/team_bank.hpp"

#include "kith/teaching/random_test.hpp"

namespace kith {

TeamBank::TeamBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
                   const std::vector<LearnerHypothesis>& hypotheses, std::span<const RandomStream> persons,
                   std::span<const std::vector<HalfSpace>> components) {
  for (const auto& person : persons)
    members_.emplace_back(cover, filter, likelihood, hypotheses, person.split("bank"), components);
}

void TeamBank::see_placement(const Atlas& atlas, std::span<const Test> tests,
                             std::span<const std::vector<Answer>> answers,
                             std::span<const std::vector<Verdict>> verdicts) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!answers[i].empty()) members_[i].see_answers(atlas, tests, answers[i], verdicts[i]);
  }
}

void TeamBank::watch(const Lesson& lesson, const std::vector<bool>& present) {
  std::vector<HalfSpace> conveyed;
  for (const auto& shown : lesson.demonstrations) {
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  for (std::size_t i = 0; i < size(); ++i) {
    if (begins(lesson.component)) members_[i].begin_component();
    if (present[i]) members_[i].watch(conveyed, lesson.period);
  }
  component_ = lesson.component;
}

void TeamBank::close_tests(const Atlas& atlas, const Lesson& lesson, std::span<const std::vector<Answer>> answers,
                           const Feedback& feedback, const std::vector<bool>& present) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!answers[i].empty()) members_[i].see_answers(atlas, lesson.tests, answers[i], feedback.verdicts[i]);
    if (present[i]) members_[i].hear_feedback(feedback.all_correct[i], feedback.half_spaces, lesson.period);
  }
}

double TeamBank::probability_of_mastery(const Atlas& atlas, const Exam& exam, std::size_t component,
                                        const std::vector<bool>& present) {
  const RandomTest test{atlas, exam, component};
  std::vector<std::vector<double>> right;
  for (std::size_t i = 0; i < size(); ++i) {
    if (present[i]) right.push_back(test.right(members_[i]));
  }
  return test.all_right(right);
}

}  // namespace kith
