#pragma once

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
  [[nodiscard]] ExamGrades grades_of(const Learner& learner, std::size_t period);
  void write(std::size_t period, const Learner& learner, const LearnerRecord& row, const ExamGrades& grades);
  void ask(const Session& session, const Learners& learners, std::vector<LearnerRecord>& rows, std::size_t member);

  TeachingCache& cache_;
  const StudySpec& spec_;
  TeamRecord& record_;
  std::vector<StartIndex> instead_;  // asked of people whose belief cannot be graded; found when first needed
};

// The exam of the team from those of its members.
void summarize_exam(TeamRecord& record, const StudySpec& spec);

}  // namespace kith
