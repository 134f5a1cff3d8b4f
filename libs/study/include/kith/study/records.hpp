#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/integer_vector.hpp"
#include "kith/study/study_spec.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// Where a team stands in a study's design.
struct TeamAddress {
  std::size_t variant = 0;  ///< Setting of the varied factors; 0 without any.
  std::string strategy = "common";
  std::string composition;
  std::size_t replicate = 1;  ///< 1, 2, ...
  std::size_t team = 1;       ///< 1, 2, ... over the whole study, in the order of the tables.
};

/// A row of responses.csv.
struct ResponseRecord {
  std::size_t period = 0;
  std::size_t component = 0;  ///< 1-based
  std::size_t test = 0;       ///< 1-based within the period
  std::size_t member = 0;     ///< 1-based
  std::size_t mdp = 0;
  std::size_t start = 0;  ///< State index in the MDP.
  bool correct = false;
  std::optional<double> regret;         ///< Missing without an answer.
  std::optional<IntegerVector> answer;  ///< Feature counts; missing without an answer.
  std::vector<HalfSpace> constraints;   ///< What the answer shows.
  std::vector<HalfSpace> covered;       ///< What the test examines and its feedback teaches.
};

/// A row of discussions.csv: an answer before and after the group saw all answers.
struct DiscussionRecord {
  std::size_t period = 0;
  std::size_t component = 0;           ///< 1-based
  std::size_t test = 0;                ///< 1-based within the period
  std::size_t member = 0;              ///< 1-based
  std::optional<IntegerVector> first;  ///< Feature counts; missing without an answer.
  bool first_correct = false;
  std::optional<IntegerVector> revised;  ///< The same as `first` if the member kept it.
  bool revised_correct = false;
};

/// A row of demonstrations.csv.
struct DemonstrationRecord {
  std::size_t period = 0;
  std::size_t member = 0;         ///< 1-based; 0: the whole team watched.
  std::size_t component = 0;      ///< 1-based
  std::size_t demonstration = 0;  ///< 1-based within the period
  std::size_t mdp = 0;
  std::size_t start = 0;               ///< State index in the MDP.
  std::vector<HalfSpace> constraints;  ///< What it conveys.
};

/// A row of progress.csv: one member at the end of one period.
struct ProgressRecord {
  std::size_t period = 0;
  std::size_t component = 0;  ///< 1-based
  std::size_t member = 0;     ///< 1-based
  char type = 'N';
  std::optional<double> ability;  ///< While watching, before scaling; none if the learner model has no such number.
  double p_bec = 0.0;             ///< Mass of the own belief in the policy's BEC, after the feedback.
  bool all_correct = false;       ///< This member answered every test of the period correctly.
};

/// What was expected of the rest of a session when a period had ended, from imagined sessions; see SessionForecasts.
struct PeriodForecast {
  double periods_left = 0.0;            ///< Mean.
  std::array<double, 3> done_within{};  ///< Probability that everything is learned after 1, 2, 3 more periods.
  friend bool operator==(const PeriodForecast&, const PeriodForecast&) = default;
};

/// What was expected of a team before its first lesson: means, and the limits of the central 80 %.
struct TeamForecast {
  double periods = 0.0, periods_low = 0.0, periods_high = 0.0;
  double minutes = 0.0, minutes_low = 0.0, minutes_high = 0.0;
  friend bool operator==(const TeamForecast&, const TeamForecast&) = default;
};

/// The probability that all members present answer a random test of the period's component correctly, after the
/// feedback.
struct PeriodMastery {
  double predicted = 0.0;          ///< By the teacher's bank of hypotheses.
  std::optional<double> actual{};  ///< By the members' own beliefs; none if a learner model has none.
  friend bool operator==(const PeriodMastery&, const PeriodMastery&) = default;
};

/// A row of periods.csv.
struct PeriodRecord {
  std::size_t period = 0;
  std::size_t member = 0;     ///< 1-based for the baseline, whose periods are numbered within the member; else 0.
  std::size_t session = 1;    ///< 1-based; periods are numbered within the session.
  std::size_t members = 0;    ///< Who took part.
  std::size_t component = 0;  ///< 1-based
  std::string source;         ///< "common", "joint" or "member N" (1-based)
  std::size_t demonstrations = 0;
  double area_sr = 0.0;
  double running_area_sr = 0.0;
  std::size_t tests = 0;
  bool all_correct = false;  ///< Everybody answered every test correctly.
  std::size_t excluded = 0;
  std::size_t untested = 0;
  std::size_t tests_demonstrated = 0;  ///< Lesson::tests_demonstrated
  double gain = 0.0;
  std::optional<PeriodForecast> forecast{};  ///< If StudySpec::forecast_sessions.
  std::optional<PeriodMastery> mastery{};    ///< If StudySpec::estimates.
  std::vector<double> p_bec;                 ///< Mass in the policy's BEC, in the order of StudySpec::teaching.rules.
};

/// One belief at the end of a period: the rows of particles.csv.
struct BeliefSnapshot {
  std::size_t period = 0;
  std::string belief;           ///< "own N", "teacher N" (member N, 1-based), "common" or "joint".
  std::vector<double> points;   ///< Directions of reward weights, axis by axis, shape [d, weights.size()].
  std::vector<double> weights;  ///< Sum to 1.
};

/// A row of exam.csv: what one member would get right outside the lessons.
struct ExamRecord {
  std::size_t period = 0;     ///< After this one; 0 before the first.
  std::size_t component = 0;  ///< 1-based; 0: over all starts.
  std::size_t member = 0;     ///< 1-based
  char type = 'N';
  double share_right = 0.0;
  double regret = 0.0;            ///< In the units of the weights that the domain file states.
  std::optional<double> p_bec{};  ///< Over all starts: mass of the belief in the policy's BEC.
};

/// A row of estimates.csv: what the teacher's bank of hypotheses says of one member, beside the truth. The row of the
/// person has what is about abilities, those of components have the rest.
struct EstimateRecord {
  std::size_t period = 0;     ///< After this one; 0 before the first.
  std::size_t component = 0;  ///< 1-based; 0: about the person.
  std::size_t member = 0;     ///< 1-based
  char type = 'N';
  std::optional<double> ability{};       ///< With which the member really learns when a component begins.
  std::optional<double> ability_mean{};  ///< Posterior mean, and the limits of the central 80 %.
  std::optional<double> ability_low{};
  std::optional<double> ability_high{};
  std::optional<double> p_proficient{};  ///< That the ability is at least StudySpec::proficient_ability.
  std::optional<double> p_knew{};        ///< That the member knew the component before the first lesson.
  std::optional<double> knew{};          ///< Mass of the member's belief then in the component's constraints.
  std::optional<double> p_right{};       ///< That the member answers a random test of the component correctly.
  std::optional<double> right{};         ///< The same under the member's own belief.
  std::vector<double> p_kinds{};         ///< That the member is of each kind, in the order of kinds_of().
  std::optional<std::string> kind{};     ///< kind_word()
  friend bool operator==(const EstimateRecord&, const EstimateRecord&) = default;
};
/// What EstimateRecord::p_proficient comes to: "proficient" from 0.8, "not proficient" up to 0.2, else "cannot tell
/// yet".
[[nodiscard]] std::string_view proficiency_word(double p_proficient) noexcept;

/// The exam of a team at its end.
struct TeamExam {
  double share_right = 0.0;        ///< Mean over members.
  double regret = 0.0;             ///< Mean over members.
  double worst_share_right = 0.0;  ///< The smallest of a member.
};

/// What teaching a team took. Minutes are those of TeachingOptions::pace.
struct TeamCost {
  std::size_t person_periods = 0;  ///< Periods that members took part in, summed over members.
  double minutes = 0.0;            ///< Of the teacher, summed over sessions.
  double person_minutes = 0.0;     ///< Of the members, summed.
  friend bool operator==(const TeamCost&, const TeamCost&) = default;
};

/// A row of learners.csv.
struct LearnerRecord {
  std::size_t member = 0;  ///< 1-based
  char type = 'N';
  std::vector<double> traits;  ///< As the model of the type declares them.
  double p_bec = 0.0;          ///< Mass of the final belief in the policy's BEC.
  std::size_t periods = 0;     ///< That the member took part in.
  std::size_t tests = 0;
  std::size_t correct = 0;
  double exam_share_right = 0.0;   ///< 0 without an exam, and so are the others.
  double exam_regret = 0.0;        ///< In the units of the weights that the domain file states.
  std::size_t exam_questions = 0;  ///< Questions of the exam that were asked.
  std::size_t exam_correct = 0;    ///< Of these, answered rightly.
};

/// Everything that is written down about one team; one row of teams.csv and those that belong to it.
struct TeamRecord {
  TeamAddress address;
  std::string seed_address;  ///< Readable address of the team's random streams.
  /// How teaching ended; for several sessions, as those of the baseline, the latest of theirs in the order of the enum.
  SessionStatus status = SessionStatus::kRunning;
  std::size_t periods = 0;
  std::size_t demonstrations = 0;
  std::size_t tests = 0;
  double knowledge = 0.0;  ///< Mean over members of LearnerRecord::p_bec.
  double knowledge_min = 0.0;
  std::size_t components_learned = 0;  ///< Summed over members for the baseline.
  std::size_t components_skipped = 0;
  double area_sr = 0.0;  ///< Mean over periods of PeriodRecord::area_sr; 0 without periods.
  TeamCost cost{};
  std::optional<TeamForecast> forecast{};  ///< If StudySpec::forecast_sessions.
  std::optional<TeamExam> exam;            ///< Unless ExamLevel::kNone.
  /// If StudySpec::beliefs: the smallest ParticleBelief::least_support() of a member's own belief; missing if no member
  /// has particles.
  std::optional<double> fewest_particles{};
  std::vector<LearnerRecord> learners;
  std::vector<PeriodRecord> period_records;                ///< Empty at RecordLevel::kTeam.
  std::vector<BeliefSnapshot> beliefs;                     ///< Empty unless RecordLevel::kParticles.
  std::vector<DemonstrationRecord> demonstration_records;  ///< Empty at RecordLevel::kTeam.
  std::vector<ResponseRecord> responses;                   ///< Empty at RecordLevel::kTeam.
  std::vector<DiscussionRecord> discussions{};             ///< Of groups that talk.
  std::vector<ProgressRecord> progress;                    ///< Empty at RecordLevel::kTeam.
  std::vector<ExamRecord> exams;                           ///< Empty at ExamLevel::kNone.
  std::vector<EstimateRecord> estimates;                   ///< Empty unless StudySpec::estimates.

  [[nodiscard]] bool completed() const noexcept { return status == SessionStatus::kComplete; }
};

}  // namespace kith
