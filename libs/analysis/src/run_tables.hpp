#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kith/analysis/dataset.hpp"
#include "kith/files/published_run.hpp"
#include "kith/study/outcomes.hpp"
#include "kith/teaching/strategy.hpp"
#include "model.hpp"

namespace kith {

// The teams of a run, and what they are compared by; one element per team.
struct RunTeams {
  Factor strategy;
  Factor composition;
  std::vector<Factor> varied;        // the study's varied keys
  std::vector<std::string> setting;  // all of the varied keys together, "" without any
  std::vector<TeamRecord> records;
  std::size_t num_features = 0;  // of the domain; 0 if the run does not say

  [[nodiscard]] bool has_exam() const { return !records.empty() && records.front().exam.has_value(); }
  [[nodiscard]] std::size_t size() const noexcept { return records.size(); }
  [[nodiscard]] bool is_baseline(std::size_t i) const { return strategy.levels[strategy.codes[i]] == kBaseline; }
  // Who is in a team: a seed address says who is taught, and settings that vary may change what these people are like.
  [[nodiscard]] std::string people(std::size_t i) const { return setting[i] + records[i].seed_address; }
  [[nodiscard]] std::vector<double> values(const StudyOutcome& outcome) const;
};

// @throws kith::Error as analyze_run does.
[[nodiscard]] RunTeams read_teams(const PublishedRun& run);

using Outcomes = std::vector<std::pair<std::string, std::vector<double>>>;
// The outcomes that a run has, in the order in which they are analysed: columns of teams.csv and their values.
[[nodiscard]] Outcomes outcomes_of(const RunTeams& teams);

// Settings make no further people: a team for each strategy and people, with the means of all settings.
[[nodiscard]] std::pair<RunTeams, Outcomes> over_settings(const RunTeams& teams, Outcomes outcomes);

// The positions of teams that were taught as groups.
[[nodiscard]] std::vector<std::size_t> group_teams(const RunTeams& teams);

template <typename T>
[[nodiscard]] std::vector<T> selected(const std::vector<T>& values, const std::vector<std::size_t>& rows) {
  std::vector<T> part;
  part.reserve(rows.size());
  for (const auto row : rows) part.push_back(values[row]);
  return part;
}
// The factor of these rows; levels that none of them has are dropped.
[[nodiscard]] Factor selected(const Factor& factor, const std::vector<std::size_t>& rows);

// Which of these teams consist of the same simulated people, as random intercepts; empty if everybody was taught once.
[[nodiscard]] std::vector<Factor> shared_people(const RunTeams& teams, const std::vector<std::size_t>& rows);

// strategy * composition, and varied keys as main effects, each only if it has levels to compare. Teams of the same
// people have a random intercept.
[[nodiscard]] ModelData team_model(const RunTeams& teams, const std::vector<std::size_t>& rows,
                                   const std::string& response, const std::vector<double>& values);

}  // namespace kith
