#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "design.hpp"
#include "run_files.hpp"

namespace kith::detail {

// The row of teams.csv.
struct TeamValues {
  bool completed = false;
  double periods = 0.0;
  double knowledge = 0.0;
  double area_sr = 0.0;
};

// What periods.csv says of one component of one team.
struct ComponentValues {
  std::size_t periods = 0;  // summed over members in the baseline
  // Over the periods behind the first one of the component (of each member, in the baseline).
  std::size_t later_periods = 0;
  double log_area_sum = 0.0;
  double area_sum = 0.0;
};

// Values of people at one time: series, learner type (position), component (from 0; 0 where all are together), period.
using PeopleKey = std::array<std::size_t, 4>;
using PeopleValues = std::map<PeopleKey, std::vector<double>>;

// Answers of people at one time; the component of the key is 0.
struct Answers {
  std::size_t people = 0;
  std::size_t answers = 0;
  std::size_t correct = 0;
};

// What the report's figures are made from, gathered in one pass over each table.
struct RunData {
  std::vector<TeamValues> teams;            // by position in the tables
  bool has_periods = false;                 // whether the level recorded what follows
  std::size_t num_components = 0;           //
  std::vector<ComponentValues> components;  // shape [teams, num_components], row-major
  PeopleValues knowledge;                   // component 0
  PeopleValues ability;
  std::map<PeopleKey, Answers> answers;
  std::vector<std::string> notes;
};

// Reads teams.csv, and with what was recorded periods, progress and responses.csv.
// @throws kith::Error for missing and damaged tables.
[[nodiscard]] RunData read_run_data(const RunFiles& run, const ReportDesign& design, std::size_t num_components,
                                    const std::function<void(std::string_view)>& on_step);

}  // namespace kith::detail
