#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/dataset.hpp"
#include "kith/core/baseline.hpp"
#include "kith/files/published_run.hpp"
#include "model.hpp"

namespace kith {

// The teams of a run, column by column; one element per team.
struct RunTeams {
  Factor strategy;
  Factor composition;
  std::vector<Factor> varied;        // the study's varied keys
  std::vector<std::string> setting;  // all of the varied keys together, "" without any
  std::vector<std::string> replicate;
  std::vector<std::string> seed_address;
  std::vector<std::string> team;
  std::vector<bool> completed;
  std::vector<bool> skipped;  // left components out; empty if the table does not say how teams ended
  std::vector<double> periods;
  std::vector<double> knowledge;
  std::vector<double> area_sr;
  std::size_t num_features = 0;  // of the domain; 0 if the run does not say
  // Of the exam at the end; empty if the teams were not examined.
  std::vector<double> exam_share_right;
  std::vector<double> exam_regret;
  std::vector<double> exam_worst_share_right;

  [[nodiscard]] bool has_exam() const noexcept { return !exam_share_right.empty(); }
  // Beyond three features knowledge says little: the exam says more.
  [[nodiscard]] bool leads_with_exam() const noexcept { return has_exam() && num_features > 3; }
  [[nodiscard]] std::size_t size() const noexcept { return team.size(); }
  [[nodiscard]] bool is_baseline(std::size_t i) const { return strategy.levels[strategy.codes[i]] == kBaseline; }
};

// @throws kith::Error as analyze_run does.
[[nodiscard]] RunTeams read_teams(const PublishedRun& run);

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
