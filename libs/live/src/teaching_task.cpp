#include "kith/live/teaching_task.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "kith/files/bytes.hpp"
#include "kith/files/sha256.hpp"
#include "kith/learners/run_period.hpp"
#include "runners_up.hpp"

namespace kith {
namespace {

Learners copies_of(const Learners& learners) {
  Learners copies;
  copies.reserve(learners.size());
  for (const auto& learner : learners) copies.push_back(learner ? learner->clone() : nullptr);
  return copies;
}

// Answers to the same tests are put in the order of members: who was first does not matter to the lesson.
std::vector<const SessionEvent*> in_order(const std::vector<const SessionEvent*>& events) {
  auto ordered = events;
  const auto is_answer = [](const SessionEvent* event) { return std::holds_alternative<TestsAnswered>(*event); };
  for (auto begin = ordered.begin(); begin != ordered.end();) {
    begin = std::find_if(begin, ordered.end(), is_answer);
    const auto end = std::find_if_not(begin, ordered.end(), is_answer);
    std::sort(begin, end, [](const SessionEvent* a, const SessionEvent* b) {
      return std::get<TestsAnswered>(*a).member < std::get<TestsAnswered>(*b).member;
    });
    begin = end;
  }
  return ordered;
}

struct EventBytes {
  ByteWriter& bytes;
  void operator()(const LessonProposed&) const {}
  void operator()(const LessonShown&) const {}
  void operator()(const TestsAnswered& event) const {
    bytes.count(event.member);
    bytes.count(event.answers.size());
    for (const auto& answer : event.answers) {
      bytes.flag(answer.has_value());
      if (answer) bytes.vector(*answer);
    }
  }
  void operator()(const TestsClosed&) const {}
  void operator()(const FeedbackGiven&) const {}
  void operator()(const MemberLeft& event) const { bytes.count(event.member); }
  void operator()(const MemberReturned& event) const { bytes.count(event.member); }
  void operator()(const StrategyChanged& event) const { bytes.text(event.strategy.name); }
  void operator()(const MemberReplaced& event) const { bytes.count(event.member); }
  void operator()(const AnswersDiscussed& event) const {
    for (std::size_t m = 0; m < event.revised.size(); ++m) (*this)(TestsAnswered{m, event.revised[m]});
  }
};

std::string key_of(const TeachingTask::Content& content) {
  std::vector<const SessionEvent*> events;
  for (const auto& event : content.session->events()) events.push_back(&event);
  for (const auto& event : content.ahead) events.push_back(&event);
  ByteWriter bytes;
  bytes.text(content.room);
  bytes.text(content.strategy ? content.strategy->name : content.session->strategy().name);
  for (const auto* event : in_order(events)) {
    bytes.count(event->index());
    std::visit(EventBytes{bytes}, *event);
  }
  return sha256(bytes.bytes()).substr(0, 32);
}

bool component_is_over(const Session& session) {
  return session.history().empty() || session.history().back().feedback.component_learned;
}

}  // namespace

TaughtLesson::TaughtLesson(const TaughtLesson& other)
    : key{other.key},
      digest{other.digest},
      after{other.after},
      learners{copies_of(other.learners)},
      responses{other.responses},
      abilities{other.abilities},
      runners_up{other.runners_up} {}

TaughtLesson& TaughtLesson::operator=(const TaughtLesson& other) {
  if (this != &other) *this = TaughtLesson{other};
  return *this;
}

TeachingTask::TeachingTask(Content content) : content_{std::move(content)}, key_{key_of(content_)} {}

TeachingTask::TeachingTask(const TeachingTask& other)
    : content_{other.content_.study, other.content_.session, other.content_.ahead, copies_of(other.content_.learners),
               other.content_.room,  other.content_.strategy},
      key_{other.key_} {}

TeachingTask& TeachingTask::operator=(const TeachingTask& other) {
  if (this != &other) *this = TeachingTask{other};
  return *this;
}

TaughtLesson TeachingTask::run(TeachingCache& cache, std::size_t num_runners_up) const {
  TaughtLesson taught;
  taught.key = key_;
  taught.learners = copies_of(content_.learners);
  auto session = *content_.session;
  for (const auto& event : content_.ahead) session.apply(event, cache);
  if (!content_.ahead.empty()) {
    const auto& past = session.history().back();
    for (std::size_t m = 0; m < taught.learners.size(); ++m) {
      if (!taught.learners[m] || !session.takes_part(m)) continue;
      taught.learners[m]->hear_feedback(past.feedback.all_right_in_the_end(m), past.feedback.half_spaces,
                                        past.lesson.period);
    }
  }
  if (content_.strategy && component_is_over(session)) session.change_strategy(*content_.strategy);
  std::optional<Session> before;
  if (num_runners_up > 0) before = session;
  const bool has_lesson = session.propose(cache);
  taught.responses.resize(taught.learners.size());
  taught.abilities.resize(taught.learners.size());
  if (has_lesson) {
    const auto& spec = content_.study->spec;
    const PeriodOptions options{.own_counterfactuals =
                                    spec.learner_counterfactuals_self ? spec.teaching.counterfactuals : 0};
    const auto& lesson = session.lesson();
    std::vector<StartIndex> tests;
    for (const auto& test : lesson.tests) tests.push_back(test.start);
    for (std::size_t m = 0; m < taught.learners.size(); ++m) {
      const auto& learner = taught.learners[m];
      if (!learner) continue;
      if (begins_component(session)) learner->begin_component();
      pass_time(*learner, session);
      if (!session.takes_part(m)) continue;
      watch_lesson(*learner, lesson, cache, options);
      taught.responses[m] = learner->answer(cache.behaviours(), tests, lesson.period);
      taught.abilities[m] = learner->ability();
    }
    if (before) taught.runners_up = runners_up(*before, lesson, cache, num_runners_up);
  }
  taught.digest = digest_of(session);
  taught.after = std::make_shared<const Session>(std::move(session));
  return taught;
}

}  // namespace kith
