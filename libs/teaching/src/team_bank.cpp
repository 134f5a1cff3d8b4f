#include "kith/teaching/team_bank.hpp"

#include <algorithm>

#include "kith/teaching/random_test.hpp"
#include "shown_by_answers.hpp"

namespace kith {

TeamBank::TeamBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
                   const std::vector<LearnerHypothesis>& hypotheses, std::span<const RandomStream> persons,
                   const std::optional<RandomStream>& everybody, double response_noise,
                   std::span<const std::vector<HalfSpace>> components)
    : likelihood_{likelihood}, everybody_{everybody}, response_noise_{response_noise} {
  for (const auto& person : persons) {
    if (everybody && !members_.empty()) {
      members_.push_back(members_.front());  // with the same people
    } else {
      members_.emplace_back(cover, filter, likelihood, hypotheses, everybody ? *everybody : person.split("bank"),
                            components);
    }
    informed_.emplace_back(cover, filter);
    random_.push_back(person.split("informed"));
  }
}

void TeamBank::restart(std::size_t i, const PriorCover& cover, const FilterOptions& filter,
                       const std::vector<LearnerHypothesis>& hypotheses, const RandomStream& person,
                       std::span<const std::vector<HalfSpace>> components) {
  members_.at(i) =
      LearnerBank{cover, filter, likelihood_, hypotheses, everybody_ ? *everybody_ : person.split("bank"), components};
  informed_[i] = ParticleBelief{cover, filter};
}

void TeamBank::inform(std::size_t i, std::span<const HalfSpace> half_spaces, const RandomStream& random) {
  constexpr double kMostAbility = 1.0 - 1e-9;
  const double ability = std::min(members_[i].expected_present_ability(), kMostAbility);
  informed_[i].observe(half_spaces, HalfSpaceLikelihood{ability, likelihood_, informed_[i].dimension()}, random);
}

// The answers of a member as evidence of what the member believes.
void TeamBank::take_answers(std::size_t i, std::span<const Verdict> verdicts, std::size_t period) {
  inform(i, shown_by(verdicts), random_[i].split(period).split("response"));
  informed_[i].diffuse(response_noise_, random_[i].split(period).split("response noise"));
}

void TeamBank::watch(const Atlas& atlas, const Lesson& lesson, const std::vector<bool>& present, double minutes) {
  std::vector<HalfSpace> conveyed;
  std::vector<StartIndex> demos;
  for (const auto& shown : lesson.demonstrations) {
    demos.push_back(shown.start);
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  LearnerBank::Changed begun, waited, seen, watched;
  for (std::size_t i = 0; i < size(); ++i) {
    if (begins(lesson.component)) members_[i].begin_component(&begun);
    if (lesson.period > 1) members_[i].let_time_pass(minutes, lesson.period, &waited);
    if (!present[i]) continue;
    members_[i].see(atlas, demos, &seen);
    members_[i].watch(conveyed, lesson.period, &watched);
    inform(i, conveyed, random_[i].split(lesson.period).split("demonstration"));
  }
  component_ = lesson.component;
}

void TeamBank::close_tests(const Atlas& atlas, const Lesson& lesson, std::span<const std::vector<Answer>> answers,
                           const Feedback& feedback, const std::vector<bool>& present) {
  LearnerBank::Changed all_right, not_all_right;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!answers[i].empty()) {
      members_[i].see_answers(AnswerFit{atlas, lesson.tests, answers[i], feedback.verdicts[i]});
      take_answers(i, feedback.verdicts[i], lesson.period);
    }
    if (!feedback.revised.empty()) {
      const auto revised = shown_by_revision(feedback.verdicts[i], feedback.revised[i]);
      if (!revised.empty()) inform(i, revised, random_[i].split(lesson.period).split("discussion"));
    }
    if (!present[i]) continue;
    const bool right = feedback.all_right_in_the_end(i);
    members_[i].hear_feedback(right, feedback.half_spaces, lesson.period, right ? &all_right : &not_all_right);
    inform(i, feedback.half_spaces, random_[i].split(lesson.period).split("feedback"));
  }
}

double TeamBank::probability_of_mastery(const Atlas& atlas, const Exam& exam, std::size_t component,
                                        const std::vector<bool>& present) {
  constexpr double kCare = 60.0;  // of those who stop, 2.9 % are declared done with 20, 1.9 % with 40, 1.6 % with 60
  const RandomTest test{atlas, exam, component};
  std::vector<std::vector<double>> right;
  for (std::size_t i = 0; i < size(); ++i) {
    if (present[i]) right.push_back(test.right(members_[i], kCare));
  }
  return test.all_right(right);
}

bool TeamBank::shows_learning(const std::vector<bool>& present, double wrongly) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (present[i] && members_[i].odds_of_learning() * wrongly < 1.0) return false;
  }
  return true;
}

}  // namespace kith
