#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kith/learners/discussion.hpp"
#include "kith/learners/learner.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// How simulated learners take part in a session.
struct PeriodOptions {
  /// If positive, learners work out for themselves what a demonstration conveys, from so many weights that they take
  /// the robot's to be, instead of learning what it conveys to the teacher's counterfactuals.
  std::size_t own_counterfactuals = 0;
  DiscussionChoice discussion{};         ///< How the group talks about its answers.
  std::span<const RandomStream> talk{};  ///< One per seat: what each person draws then; empty if they do not talk.
};

/// Whether the session's lesson is the first one of its component: Learner::begin_component() is called before it.
[[nodiscard]] bool begins_component(const Session& session);

/// The time that the period before took (TeachingOptions::pace) passes for a learner. @param session  in which a lesson
/// was chosen.
void pass_time(Learner& learner, const Session& session);

/// A learner watches the demonstrations of a lesson. @param cache  of the session's atlas; changes no result.
void watch_lesson(Learner& learner, const Lesson& lesson, TeachingCache& cache, const PeriodOptions& options = {});

/// What learners did in a period; lesson, answers and feedback are in Session::history().back().
struct PeriodOfLearners {
  std::vector<Learner::Response> responses;      ///< Per member; empty for who was away.
  std::vector<std::optional<double>> abilities;  ///< Per member, while watching.
};

/// One interaction period of simulated learners: the loop that studies, transcripts, power and tests
/// share. The learners watch the lesson that Session::propose() chose, answer its tests and hear the feedback. Members
/// who are away do nothing.
///
///   while (session.propose(cache)) run_period(session, cache, learners);
///
/// @param cache  of the session's atlas; changes no result.
/// @param learners  one per seat.
/// @throws std::invalid_argument unless there is one learner per seat; kith::Error as the events of Session.
PeriodOfLearners run_period(Session& session, TeachingCache& cache, Learners& learners,
                            const PeriodOptions& options = {});

/// The members of a session as they are now, for a strategy that asks for it; see Session::propose(). The beliefs stay
/// those of the learners. @pre one learner per seat.
[[nodiscard]] std::vector<MemberTruth> truth_about(const Session& session, const Learners& learners);

}  // namespace kith
