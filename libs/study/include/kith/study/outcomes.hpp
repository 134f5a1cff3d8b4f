#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "kith/study/records.hpp"

namespace kith {

/// What is measured about a team: a column of teams.csv with all that analyses, plans and reports say about it. A new
/// outcome is one row of the table in outcomes.cpp.
struct StudyOutcome {
  std::string_view column{};   ///< "exam_regret"
  std::string_view name{};     ///< "regret in the exam"; with a capital, the heading of its column.
  std::string_view phrase{};   ///< The same in sentences about the end of a study: "knowledge at the end".
  std::string_view better{};   ///< What a better way of teaching leads to: "less regret in the exam".
  std::string_view stem{};     ///< Of the headings of its statistics: "Regret".
  std::string_view meaning{};  ///< A sentence, if it needs one.
  double (*of)(const TeamRecord&) = nullptr;  ///< @throws std::invalid_argument for a team that was not examined.
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();  ///< Infinite: as large as may be.
  int digits = 2;                                         ///< Decimals of means.
  bool needs_exam = false;
  bool is_plural = false;
  bool less_is_better = false;
  /// From 1, among those that are analysed where the exam leads; 0: not analysed by itself.
  std::size_t place = 0;
};

/// All of them, in the order in which they are listed and analysed; those of the exam come last.
[[nodiscard]] std::span<const StudyOutcome> outcomes() noexcept;
/// Null if no outcome has this column.
[[nodiscard]] const StudyOutcome* find_outcome(std::string_view column) noexcept;
/// @throws std::invalid_argument if no outcome has this column.
[[nodiscard]] const StudyOutcome& outcome_named(std::string_view column);

/// Beyond three features knowledge says little: the exam, if there is one, leads and knowledge comes last.
[[nodiscard]] constexpr bool exam_leads(bool has_exam, std::size_t num_features) noexcept {
  return has_exam && num_features > 3;
}
/// Those that are analysed of teams with or without an exam, in that order.
[[nodiscard]] std::vector<const StudyOutcome*> analysed_outcomes(bool has_exam, bool is_led_by_exam);

}  // namespace kith
