#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kith/learners/learner.hpp"
#include "kith/live/live_study.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// A demonstration that the teacher would have shown if it could not have shown those before it.
struct RunnerUp {
  StartIndex start;
  double gain = 1.0;
  std::vector<HalfSpace> half_spaces;
};

/// A lesson that a worker made: what Room::taught() and Room::apply() take. A value; keep it until its event is
/// applied.
struct TaughtLesson {
  std::string key;     ///< TeachingTask::key of the task.
  std::string digest;  ///< Of the session after the proposal: lesson, beliefs and history.
  std::shared_ptr<const Session> after;
  Learners learners;                         ///< Stand-ins after they watched the lesson; null for people.
  std::vector<Learner::Response> responses;  ///< Their answers; empty for people.
  std::vector<std::optional<double>> abilities;
  std::vector<RunnerUp> runners_up;  ///< Of the first demonstration, best first; only for the facilitator.

  TaughtLesson() = default;
  TaughtLesson(const TaughtLesson& other);
  TaughtLesson& operator=(const TaughtLesson& other);
  TaughtLesson(TaughtLesson&&) noexcept = default;
  TaughtLesson& operator=(TaughtLesson&&) noexcept = default;
  ~TaughtLesson() = default;
};

/// The choice of a room's next lesson: all that is needed to make it on another thread, copied from the room. Two tasks
/// with the same key lead to the same lesson, so what was computed ahead of time serves if keys are equal.
class TeachingTask {
 public:
  /// What Room makes tasks from.
  struct Content {
    std::shared_ptr<const LiveStudy> study;
    std::shared_ptr<const Session> session;
    std::vector<SessionEvent> ahead;         ///< What is assumed to happen before the lesson is chosen.
    Learners learners;                       ///< Per member; null for people.
    std::string room;                        ///< Address of its streams, part of the key.
    std::optional<StrategyChoice> strategy;  ///< Takes over if a component begins.
  };
  explicit TeachingTask(Content content);
  TeachingTask(const TeachingTask& other);
  TeachingTask& operator=(const TeachingTask& other);
  TeachingTask(TeachingTask&&) noexcept = default;
  TeachingTask& operator=(TeachingTask&&) noexcept = default;
  ~TeachingTask() = default;

  [[nodiscard]] const std::string& key() const noexcept { return key_; }
  /// Chooses the lesson; takes milliseconds to seconds. A pure function of the task.
  /// @param cache  of the calling thread; changes no result.
  /// @param num_runners_up  that are looked for besides; each takes about as long as the lesson.
  [[nodiscard]] TaughtLesson run(TeachingCache& cache, std::size_t num_runners_up = 0) const;

 private:
  Content content_;
  std::string key_;
};

/// A digest of all that a session knows: events, lesson, history and beliefs. Equal sessions have equal digests on one
/// kind of machine.
[[nodiscard]] std::string digest_of(const Session& session);

}  // namespace kith
