#pragma once

#include <string>
#include <vector>

#include "kith/study/study.hpp"

namespace kith {

// Which columns the tables of a study have besides those that every study has: what study_tables() describes and what
// rows hold.
struct OptionalColumns {
  bool costs = false;
  bool forecasts = false;
  bool estimates = false;
  bool beliefs = false;
  bool subgroups = false;
  std::vector<std::string> traits;  // of learners.csv
};
[[nodiscard]] OptionalColumns optional_columns(const Study& study);

}  // namespace kith
