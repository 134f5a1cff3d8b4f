#include "outcomes.hpp"

#include <algorithm>
#include <array>

#include "kith/table/column_names.hpp"

namespace kith {
namespace {

constexpr std::array kOutcomes{
    OutcomeWords{columns::kPeriods, "periods", "fewer periods", true},
    OutcomeWords{columns::kKnowledge, "knowledge", "more knowledge"},
    OutcomeWords{columns::kExamShareRight, "share right in the exam", "a larger share right in the exam"},
    OutcomeWords{columns::kExamRegret, "regret in the exam", "less regret in the exam"},
    OutcomeWords{columns::kExamWorstShareRight, "worst member's share right in the exam",
                 "a larger share right of the worst member in the exam"},
};

}  // namespace

OutcomeWords outcome_words(std::string_view column) {
  const auto found =
      std::find_if(kOutcomes.begin(), kOutcomes.end(), [&](const auto& one) { return one.column == column; });
  if (found != kOutcomes.end()) return *found;
  return {column, column, column};
}

std::vector<std::pair<std::string, const std::vector<double>*>> outcomes_of(const RunTeams& teams) {
  using Outcomes = std::vector<std::pair<std::string, const std::vector<double>*>>;
  if (teams.leads_with_exam()) {
    return Outcomes{{columns::kExamRegret, &teams.exam_regret},
                    {columns::kExamShareRight, &teams.exam_share_right},
                    {columns::kExamWorstShareRight, &teams.exam_worst_share_right},
                    {columns::kPeriods, &teams.periods},
                    {columns::kKnowledge, &teams.knowledge}};
  }
  Outcomes outcomes{{columns::kPeriods, &teams.periods}, {columns::kKnowledge, &teams.knowledge}};
  if (!teams.has_exam()) return outcomes;
  outcomes.emplace_back(columns::kExamShareRight, &teams.exam_share_right);
  outcomes.emplace_back(columns::kExamRegret, &teams.exam_regret);
  outcomes.emplace_back(columns::kExamWorstShareRight, &teams.exam_worst_share_right);
  return outcomes;
}

}  // namespace kith
