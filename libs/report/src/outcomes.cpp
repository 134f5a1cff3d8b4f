#include "outcomes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "kith/teaching/strategy.hpp"
#include "sentences.hpp"

namespace kith::detail {

Json outcome_json(const StudyOutcome& outcome) {
  return {{"column", outcome.column},
          {"name", capitalised(std::string{outcome.phrase})},
          {"axis", outcome.stem},
          {"better", outcome.better},
          {"meaning", outcome.meaning},
          {"digits", outcome.digits},
          {"less_is_better", outcome.less_is_better},
          {"of_exam", outcome.needs_exam},
          {"high", number(outcome.high)}};
}

Json outcomes_json(bool has_exam) {
  Json list = Json::array();
  for (const auto* outcome : analysed_outcomes(has_exam, false)) list.push_back(outcome_json(*outcome));
  return list;
}

const ReportDesign::Series& series_of(const FirstScreen& screen, std::size_t team) {
  return screen.design.series[screen.design.cells[screen.design.cell_of_team[team]].series];
}
const std::string& composition_of(const FirstScreen& screen, std::size_t team) {
  return screen.design.cells[screen.design.cell_of_team[team]].composition;
}
bool is_alone(const FirstScreen& screen, std::size_t team) { return series_of(screen, team).strategy == kBaseline; }

Values values_of(const FirstScreen& screen, const StudyOutcome& outcome, bool alone) {
  Values values;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    const double value = outcome.of(screen.data.teams[i]);
    if (is_alone(screen, i) == alone && std::isfinite(value)) values.push_back(value);
  }
  return values;
}

TeamValues by_people(const FirstScreen& screen, const StudyOutcome& outcome,
                     const std::function<bool(std::size_t)>& is_of) {
  TeamValues values;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    const double value = outcome.of(screen.data.teams[i]);
    if (!is_of(i) || !std::isfinite(value)) continue;
    const auto strategy = screen.paired ? "" : series_of(screen, i).strategy + " ";
    const auto people = screen.simulated
                            ? TeamPeople{strategy + composition_of(screen, i), screen.data.teams[i].address.replicate}
                            : TeamPeople{"", i};
    values[people].push_back(value);
  }
  return values;
}

bool has_fixed_periods(const FirstScreen& screen) {
  const auto is_fixed = [&](bool alone) {
    const auto periods = values_of(screen, kPeriods, alone);
    return std::all_of(periods.begin(), periods.end(), [&](double value) { return value == periods.front(); });
  };
  return screen.data.teams.size() > screen.design.cells.size() && is_fixed(false) && is_fixed(true);
}

bool compares_with_alone(const FirstScreen& screen) {
  const auto& series = screen.design.series;
  const auto alone = std::count_if(series.begin(), series.end(), [](auto& one) { return one.strategy == kBaseline; });
  return alone > 0 && static_cast<std::size_t>(alone) < series.size();
}

StudyOutcome known(const FirstScreen& screen) {
  auto outcome = outcome_named(screen.data.leads_with_exam ? columns::kExamShareRight : columns::kKnowledge);
  if (!screen.simulated) outcome.phrase = "estimated knowledge at the end";
  return outcome;
}

// A period of a team takes the time of everybody in it, so that the comparison with teaching alone needs both counts.
std::vector<StudyOutcome> outcomes_of(const FirstScreen& screen) {
  std::vector<StudyOutcome> outcomes;
  if (!has_fixed_periods(screen)) {
    outcomes.push_back(kPeriods);
    if (compares_with_alone(screen)) outcomes.push_back(kPersonPeriods);
  }
  outcomes.push_back(known(screen));
  if (screen.data.has_exam && !screen.data.leads_with_exam) outcomes.push_back(outcome_named(columns::kExamShareRight));
  return outcomes;
}

std::size_t num_together(const FirstScreen& screen) {
  std::set<std::string> strategies;
  for (const auto& series : screen.design.series) {
    if (series.strategy != kBaseline) strategies.insert(series.strategy);
  }
  return strategies.size();
}

}  // namespace kith::detail
