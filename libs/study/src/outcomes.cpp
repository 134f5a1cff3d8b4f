#include "kith/study/outcomes.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "kith/files/column_names.hpp"

namespace kith {
namespace {

const TeamExam& exam_of(const TeamRecord& team) {
  if (!team.exam) throw std::invalid_argument{"StudyOutcome: the team was not examined"};
  return *team.exam;
}

constexpr std::array kOutcomes{
    StudyOutcome{.column = columns::kPeriods,
                 .name = "periods",
                 .phrase = "periods",
                 .better = "fewer periods",
                 .stem = "Periods",
                 .of = [](const TeamRecord& team) { return static_cast<double>(team.periods); },
                 .digits = 1,
                 .is_plural = true,
                 .less_is_better = true,
                 .place = 4},
    StudyOutcome{.column = columns::kKnowledge,
                 .name = "knowledge",
                 .phrase = "knowledge at the end",
                 .better = "more knowledge",
                 .stem = "Knowledge",
                 .meaning = "Knowledge is the share of belief in the policy's region (BEC).",
                 .of = [](const TeamRecord& team) { return team.knowledge; },
                 .high = 1.0,
                 .place = 5},
    StudyOutcome{.column = columns::kCompleted,
                 .name = "completed",
                 .phrase = "completed",
                 .better = "more teams that learn everything",
                 .stem = "Completed",
                 .of = [](const TeamRecord& team) { return team.completed() ? 1.0 : 0.0; },
                 .high = 1.0},
    StudyOutcome{.column = columns::kAreaSr,
                 .name = "area",
                 .phrase = "area",
                 .better = "a smaller area",
                 .stem = "Area (sr)",
                 .of = [](const TeamRecord& team) { return team.area_sr; },
                 .less_is_better = true},
    StudyOutcome{.column = columns::kExamShareRight,
                 .name = "share right in the exam",
                 .phrase = "share right in the exam",
                 .better = "a larger share right in the exam",
                 .stem = "Share right",
                 .meaning = "It is the share of all starts from which members predict the robot.",
                 .of = [](const TeamRecord& team) { return exam_of(team).share_right; },
                 .high = 1.0,
                 .needs_exam = true,
                 .place = 2},
    StudyOutcome{.column = columns::kExamRegret,
                 .name = "regret in the exam",
                 .phrase = "regret in the exam",
                 .better = "less regret in the exam",
                 .stem = "Regret",
                 .meaning = "Regret is what the members' predictions lose against the robot's paths over all starts.",
                 .of = [](const TeamRecord& team) { return exam_of(team).regret; },
                 .digits = 3,
                 .needs_exam = true,
                 .less_is_better = true,
                 .place = 1},
    StudyOutcome{.column = columns::kExamWorstShareRight,
                 .name = "worst member's share right in the exam",
                 .phrase = "worst member's share right in the exam",
                 .better = "a larger share right of the worst member in the exam",
                 .stem = "Worst member's share right",
                 .meaning = "The worst member is the one who does worst in the exam.",
                 .of = [](const TeamRecord& team) { return exam_of(team).worst_share_right; },
                 .high = 1.0,
                 .needs_exam = true,
                 .place = 3},
};

}  // namespace

std::span<const StudyOutcome> outcomes() noexcept { return kOutcomes; }

const StudyOutcome* find_outcome(std::string_view column) noexcept {
  const auto* const found = std::ranges::find(kOutcomes, column, &StudyOutcome::column);
  return found == kOutcomes.end() ? nullptr : found;
}

const StudyOutcome& outcome_named(std::string_view column) {
  const auto* const found = find_outcome(column);
  if (found == nullptr) throw std::invalid_argument{"outcome_named: no outcome " + std::string{column}};
  return *found;
}

std::vector<const StudyOutcome*> analysed_outcomes(bool has_exam, bool is_led_by_exam) {
  std::vector<const StudyOutcome*> analysed;
  for (const auto& outcome : kOutcomes) {
    if (outcome.place > 0 && (has_exam || !outcome.needs_exam)) analysed.push_back(&outcome);
  }
  if (is_led_by_exam) std::ranges::sort(analysed, {}, &StudyOutcome::place);
  return analysed;
}

}  // namespace kith
