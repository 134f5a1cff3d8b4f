#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run_tables.hpp"

namespace kith {

// How an outcome of teams is named.
struct OutcomeWords {
  std::string_view column;  // of teams.csv
  std::string_view label;   // "knowledge", "regret in the exam"
  std::string_view better;  // what a better way of teaching leads to: "more knowledge"
  bool is_plural = false;
};
// Of a column that is no outcome of teams: its name.
[[nodiscard]] OutcomeWords outcome_words(std::string_view column);

// The outcomes that a run has, in the order in which they are analysed: columns of teams.csv and their values. Beyond
// three features those of the exam come first and knowledge, which says little there, comes last.
[[nodiscard]] std::vector<std::pair<std::string, const std::vector<double>*>> outcomes_of(const RunTeams& teams);

}  // namespace kith
