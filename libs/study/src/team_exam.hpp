#pragma once

#include <optional>
#include <vector>

#include "kith/learners/learner.hpp"
#include "kith/study/records.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

// Examines the people of one session, as the study asks, and writes down how they do.
class TeamExaminer {
 public:
  TeamExaminer(TeachingCache& cache, const StudySpec& spec, TeamRecord& record)
      : cache_{cache}, spec_{spec}, record_{record} {}

  // Before the first period. @param rows  of the same people as `learners`.
  void at_start(const Learners& learners, const std::vector<LearnerRecord>& rows) { after_period(0, learners, rows); }
  void after_period(std::size_t period, const Learners& learners, const std::vector<LearnerRecord>& rows);
  // Also fills in what the rows have about exams.
  // @param member  who is taught alone, 1-based; 0: the whole team.
  void at_end(const Session& session, const Learners& learners, std::vector<LearnerRecord>& rows, std::size_t member);

 private:
  // What a person's answer at a start is worth more than the best path for the weights they have in mind.
  struct Change {
    StartIndex start;
    Grade grade;
  };

  [[nodiscard]] ExamGrades grades_of(const Learner& learner, std::size_t period);
  void add_changes(std::vector<Change>& changes, const Learner& learner, const std::vector<StartIndex>& starts,
                   const std::optional<Direction>& weights, std::size_t period);
  void add_means(const std::vector<Change>& changes, ExamGrades& grades) const;
  void write(std::size_t period, const Learner& learner, const LearnerRecord& row, const ExamGrades& grades);
  void ask(const Session& session, const Learners& learners, std::vector<LearnerRecord>& rows, std::size_t member);

  TeachingCache& cache_;
  const StudySpec& spec_;
  TeamRecord& record_;
  std::vector<StartIndex> asked_;  // of people who do not answer as they believe; found when first needed
};

// The exam of the team from those of its members.
void summarize_exam(TeamRecord& record, const StudySpec& spec);

}  // namespace kith
