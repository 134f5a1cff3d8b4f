#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kith/learners/learner.hpp"
#include "kith/study/records.hpp"
#include "kith/teaching/forecast.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// One belief in figures.
struct BeliefFigures {
  std::string whose;            ///< "member 1", "common", "joint"
  double p_bec = 0.0;           ///< Mass in the behaviour equivalence class of the policy.
  double p_taught = 0.0;        ///< Mass in the region of what the lesson teaches.
  std::optional<double> ess{};  ///< Effective sample size; none if there is no particle belief.
};

/// All beliefs at one moment: the members' own, and what the teacher believes.
struct BeliefState {
  std::vector<BeliefFigures> own;
  std::vector<BeliefFigures> teacher;
  std::vector<std::optional<double>> abilities;  ///< Per member, if the learner model has such a number.
};

/// One period, start to end.
struct TranscriptPeriod {
  Lesson lesson;
  BeliefState before, after;
  std::vector<Learner::Response> responses;  ///< Per member.
  Feedback feedback;
  std::vector<std::vector<Answer>> revised{};  ///< As PastPeriod::revised.
  std::optional<PeriodForecast> forecast{};    ///< What was expected of the rest, if StudySpec::forecast_sessions.
};

/// One session: the team's, or one member's in the baseline.
struct TranscriptSession {
  std::vector<std::size_t> members;  ///< Their numbers in the team, 1-based.
  std::vector<TranscriptPeriod> periods;
  SessionStatus status = SessionStatus::kRunning;
  std::vector<ComponentStatus> components;
};

/// Everything that happened to one team.
struct Transcript {
  StudySpec spec;
  TeamAddress address;
  TeamRecord record;
  std::vector<TranscriptSession> sessions;
  std::vector<PastSession> imagined{};  ///< Of the same crew, for the forecast; empty without one.
};

/// Teaches the team and writes down all of it.
[[nodiscard]] Transcript transcribe(const Atlas& atlas, const StudySpec& spec, const TeamAddress& address);

/// The transcript for people: plain ASCII text, the same for the same inputs.
[[nodiscard]] std::string to_text(const Atlas& atlas, const Transcript& transcript);
/// How it begins: what is taught to whom, and how to read the rest.
[[nodiscard]] std::string transcript_header(const Atlas& atlas, const Transcript& transcript);

/// The path that a person with these weights takes, if it has the given feature counts.
[[nodiscard]] std::optional<Trajectory> path_of_answer(const Atlas& atlas, StartIndex test, const IntegerVector& counts,
                                                       const Direction& weights);

}  // namespace kith
