#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "design.hpp"
#include "kith/study/outcomes.hpp"
#include "run_files.hpp"

namespace kith::detail {

// Demonstrations and tests.
[[nodiscard]] inline double items_of(const TeamRecord& team) {
  return static_cast<double>(team.demonstrations + team.tests);
}

// A team when so many periods were taught: means over its members, and what teaching had taken by then.
struct ExamPoint {
  double regret = 0.0;
  double share_right = 0.0;
  double worst_share_right = 0.0;
  double knowledge = 0.0;
  double items = 0.0;
  double minutes = 0.0;
  double person_minutes = 0.0;
};

// Forecasts of about the same probability, and how many of them came true.
struct ForecastBin {
  double predicted = 0.0;  // sum
  std::size_t n = 0;
  std::size_t done = 0;
};

// Predicted probabilities of mastery of about the same size, and the true ones.
struct MasteryBin {
  double predicted = 0.0;  // sums
  double actual = 0.0;
  double actual_squares = 0.0;
  std::size_t n = 0;
};

// Estimates of the abilities of people at one time, beside the truth.
struct AbilityEstimates {
  std::vector<double> actual;
  std::vector<double> estimated;
  std::size_t within = 0;  // central 80 % intervals that contain the truth
  std::size_t told = 0;    // said to be proficient or not
  std::size_t told_correctly = 0;
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
  // By position in the tables. Person-periods are periods times members, but for the baseline.
  std::vector<TeamRecord> teams;
  bool has_periods = false;                 // whether the level recorded what follows
  std::size_t num_components = 0;           //
  std::vector<ComponentValues> components;  // shape [teams, num_components], row-major
  PeopleValues knowledge;                   // component 0
  PeopleValues knowledge_at_end;            // of those who were taught last in this period
  std::map<PeopleKey, Answers> answers;
  bool has_exam = false;
  // Beyond three features knowledge says little, so that the exam leads; set by read_run_data().
  bool leads_with_exam = false;
  bool has_costs = false;
  bool has_forecasts = false;
  std::vector<std::vector<ExamPoint>> exam_paths;  // by team: before teaching, after each period; may be empty
  std::array<std::array<ForecastBin, 10>, 3> calibration{};  // done after 1, 2, 3 more periods, by tenths
  bool has_estimates = false;
  std::array<MasteryBin, 10> mastery{};                                               // by tenths
  std::map<std::pair<std::size_t, std::size_t>, AbilityEstimates> ability_estimates;  // by series and period
  std::vector<std::string> notes;
};

// Reads teams.csv, and with what was recorded periods, progress and responses.csv.
// @throws kith::Error for missing and damaged tables.
[[nodiscard]] RunData read_run_data(const RunFiles& run, const ReportDesign& design, std::size_t num_components,
                                    const std::function<void(std::string_view)>& on_step);

}  // namespace kith::detail
