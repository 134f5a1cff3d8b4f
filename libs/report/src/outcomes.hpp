#pragma once

#include <functional>
#include <string>
#include <vector>

#include "first_screen.hpp"
#include "kith/analysis/team_difference.hpp"
#include "kith/files/column_names.hpp"
#include "team_tables.hpp"

namespace kith::detail {

// What teams are compared by on the first screen.
inline const StudyOutcome kPeriods = outcome_named(columns::kPeriods);
inline const StudyOutcome kPersonPeriods{
    .column = "person-periods",
    .phrase = "person-periods",
    .of = [](const TeamRecord& team) { return static_cast<double>(team.cost.person_periods); },
    .digits = kPeriods.digits};

// What pages say of an outcome: {"column", "name", "axis", "better", "meaning", "digits", "less_is_better", "of_exam",
// "high"}.
[[nodiscard]] Json outcome_json(const StudyOutcome& outcome);
// Of those that are analysed.
[[nodiscard]] Json outcomes_json(bool has_exam);

// What says how much a team knows.
[[nodiscard]] StudyOutcome known(const FirstScreen& screen);
[[nodiscard]] std::vector<StudyOutcome> outcomes_of(const FirstScreen& screen);

[[nodiscard]] const ReportDesign::Series& series_of(const FirstScreen& screen, std::size_t team);
[[nodiscard]] const std::string& composition_of(const FirstScreen& screen, std::size_t team);
// Whether the team's members were taught one after the other.
[[nodiscard]] bool is_alone(const FirstScreen& screen, std::size_t team);
[[nodiscard]] bool compares_with_alone(const FirstScreen& screen);
// Strategies that teach a team together.
[[nodiscard]] std::size_t num_together(const FirstScreen& screen);

// Whether every team had as many periods as any other that was taught together, or alone: counting finds out nothing.
[[nodiscard]] bool has_fixed_periods(const FirstScreen& screen);

// The finite values of the teams that were taught together, or alone.
[[nodiscard]] Values values_of(const FirstScreen& screen, const StudyOutcome& outcome, bool alone);
// The finite values of some teams. A replicate is the same people at all settings, and if paired under all strategies.
[[nodiscard]] TeamValues by_people(const FirstScreen& screen, const StudyOutcome& outcome,
                                   const std::function<bool(std::size_t)>& is_of);

}  // namespace kith::detail
