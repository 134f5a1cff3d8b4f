#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kith/learners/learner.hpp"
#include "kith/study/records.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

// Writes down what the teacher's bank of hypotheses says of the people of one session, beside the truth: before the
// first period and after every one, or at the end only if only teams are recorded.
class TeamEstimates {
 public:
  TeamEstimates(TeachingCache& cache, const StudySpec& spec, TeamRecord& record)
      : cache_{cache}, spec_{spec}, record_{record} {}

  // @param rows  of the same people as `learners`.
  void at_start(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows);
  void after_period(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows);
  void at_end(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows);

 private:
  [[nodiscard]] bool is_asked() const { return spec_.estimates; }
  void write(const Session& session, const Learners& learners, const std::vector<LearnerRecord>& rows);
  void write_person(EstimateRecord record, const LearnerBank& bank, const Learner& learner);
  void write_components(const EstimateRecord& record, LearnerBank& bank, const Learner& learner, std::size_t member);

  TeachingCache& cache_;
  const StudySpec& spec_;
  TeamRecord& record_;
  std::vector<std::vector<double>> knew_;  // shape [members, components]
};

// Of the component of the last period; nothing unless the study records estimates.
// @param present  seats of those who took part in the period.
[[nodiscard]] std::optional<PeriodMastery> mastery_after(TeachingCache& cache, const StudySpec& spec,
                                                         const Session& session, const Learners& learners,
                                                         std::span<const std::size_t> present);

}  // namespace kith
