#include "kith/learners/run_period.hpp"

#include <stdexcept>

namespace kith {

bool begins_component(const Session& session) {
  const auto& history = session.history();
  return history.empty() || history.back().lesson.component != session.lesson().component;
}

void pass_time(Learner& learner, const Session& session) {
  if (session.history().empty()) return;
  const auto& before = session.history().back();
  learner.let_time_pass(minutes_of(session.options().pace, before), before.lesson.period + 1);
}

void watch_lesson(Learner& learner, const Lesson& lesson, TeachingCache& cache, const PeriodOptions& options) {
  std::vector<StartIndex> demos;
  for (const auto& shown : lesson.demonstrations) demos.push_back(shown.start);
  learner.see(cache.atlas(), demos);
  std::vector<Direction> expected;
  if (options.own_counterfactuals > 0) expected = learner.imagined_weights(options.own_counterfactuals, lesson.period);
  if (expected.empty()) {
    std::vector<HalfSpace> conveyed;
    for (const auto& shown : lesson.demonstrations) {
      conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
    }
    learner.watch(conveyed, lesson.period);
  } else {
    learner.watch(conveyed_to(cache.behaviours(), cache.regions(), demos, expected), lesson.period);
  }
}

std::vector<MemberTruth> truth_about(const Session& session, const Learners& learners) {
  const bool begins = session.history().empty() || session.history().back().feedback.component_learned;
  std::vector<MemberTruth> truth;
  for (const auto& learner : learners) {
    auto& one = truth.emplace_back();
    const auto abilities = learner->learning_abilities(begins);
    if (!abilities) continue;
    one = {learner->belief(), abilities->shown, abilities->feedback};
  }
  return truth;
}

PeriodOfLearners run_period(Session& session, TeachingCache& cache, Learners& learners, const PeriodOptions& options) {
  if (learners.size() != session.num_members()) {
    throw std::invalid_argument{"run_period: there must be one learner per seat"};
  }
  const Lesson& lesson = session.lesson();
  const bool begins = begins_component(session);
  std::vector<StartIndex> tests;
  for (const auto& test : lesson.tests) tests.push_back(test.start);
  session.show();
  PeriodOfLearners period;
  period.responses.resize(learners.size());
  period.abilities.resize(learners.size());
  for (std::size_t i = 0; i < learners.size(); ++i) {
    if (begins) learners[i]->begin_component();
    pass_time(*learners[i], session);
    if (!session.takes_part(i)) continue;
    watch_lesson(*learners[i], lesson, cache, options);
    period.responses[i] = learners[i]->answer(cache.behaviours(), tests, lesson.period);
    period.abilities[i] = learners[i]->ability();
    session.answer(i, period.responses[i].answers);
  }
  if (options.discussion.is_held() && can_discuss(session)) {
    std::vector<Learner*> talking;
    for (const auto& learner : learners) talking.push_back(learner.get());
    session.discuss(discuss(options.discussion, session, cache, talking, options.talk));
  }
  session.close_tests();
  std::vector<bool> hears;  // also who is released after this period
  for (std::size_t i = 0; i < learners.size(); ++i) hears.push_back(session.takes_part(i));
  const auto& feedback = session.give_feedback();
  for (std::size_t i = 0; i < learners.size(); ++i) {
    if (!hears[i]) continue;
    learners[i]->hear_feedback(feedback.all_right_in_the_end(i), feedback.half_spaces,
                               session.history().back().lesson.period);
  }
  return period;
}

}  // namespace kith
