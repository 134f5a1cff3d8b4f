#include "outcomes.hpp"

#include <algorithm>
#include <array>

namespace kith {
namespace {

constexpr std::array kOutcomes{
    OutcomeWords{"periods", "periods", "fewer periods", true},
    OutcomeWords{"knowledge", "knowledge", "more knowledge"},
    OutcomeWords{"exam_share_right", "share right in the exam", "a larger share right in the exam"},
    OutcomeWords{"exam_regret", "regret in the exam", "less regret in the exam"},
    OutcomeWords{"exam_worst_share_right", "worst member's share right in the exam",
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
    return Outcomes{{"exam_regret", &teams.exam_regret},
                    {"exam_share_right", &teams.exam_share_right},
                    {"exam_worst_share_right", &teams.exam_worst_share_right},
                    {"periods", &teams.periods},
                    {"knowledge", &teams.knowledge}};
  }
  Outcomes outcomes{{"periods", &teams.periods}, {"knowledge", &teams.knowledge}};
  if (!teams.has_exam()) return outcomes;
  outcomes.emplace_back("exam_share_right", &teams.exam_share_right);
  outcomes.emplace_back("exam_regret", &teams.exam_regret);
  outcomes.emplace_back("exam_worst_share_right", &teams.exam_worst_share_right);
  return outcomes;
}

}  // namespace kith
