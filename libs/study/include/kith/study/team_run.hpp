#pragma once

#include <functional>
#include <optional>
#include <span>

#include "kith/learners/learner.hpp"
#include "kith/study/records.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

class SessionForecasts;

/// Watches a team being taught, for transcripts. All calls come in the order of events, from the thread that runs the
/// team.
class TeamObserver {
 public:
  virtual ~TeamObserver() = default;
  /// A session begins. @param members  who sits in its seats, 1-based: the whole team, or one member or those of one
  /// type who are taught apart.
  virtual void on_session(const Session& session, std::span<const std::size_t> members) = 0;
  /// The lesson of the coming period, before anybody saw it.
  virtual void on_lesson(const Session& session, const Lesson& lesson, const Learners& learners) = 0;
  /// Everybody watched, answered and heard the feedback; learners and session are as they are afterwards.
  virtual void on_feedback(const Session& session, const Lesson& lesson,
                           const std::vector<Learner::Response>& responses, const Feedback& feedback,
                           const Learners& learners) = 0;
  /// The session has ended.
  virtual void on_end(const Session& session, const Learners& learners) = 0;
};

/// Teaches one simulated team to the end and writes everything down. The outcome depends on the specification
/// and the address only. The baseline is a sequence of one-person sessions of the same people.
/// @param cache  of the calling thread; influences nothing.
/// @param observer  may be null. With an observer, all beliefs are kept up to date.
/// @param forecasts  of the study, for a record with forecasts if StudySpec::forecast_sessions; null: without.
[[nodiscard]] TeamRecord run_team(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec,
                                  const TeamAddress& address, TeamObserver* observer = nullptr,
                                  SessionForecasts* forecasts = nullptr);

/// The same, given up as soon as `stopped` says so, which is asked before every period: then nothing. May be empty.
[[nodiscard]] std::optional<TeamRecord> run_team_unless(const std::function<bool()>& stopped, const Atlas& atlas,
                                                        TeachingCache& cache, const StudySpec& spec,
                                                        const TeamAddress& address, SessionForecasts* forecasts);

}  // namespace kith
