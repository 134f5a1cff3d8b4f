#include "kith/fit/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

GridSearchGroup search(const std::string& name, const std::vector<std::size_t>& people, const ResponseLogs& logs,
                       const LikelihoodTable& table, double epsilon) {
  GridSearchGroup group{.name = name, .people = people.size()};
  group.least_error = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < table.grid.size(); ++i) {
    const auto point = table.grid.point(i);
    if (point.confirm_gain >= point.correct_gain) continue;
    ++group.points;
    double error = 0.0;
    for (const auto person : people) {
      const auto& log = logs.people[person];
      const double share = static_cast<double>(log.final_correct) / static_cast<double>(log.final_tests);
      error += std::abs(table.knowledge[person][i] - share) / static_cast<double>(people.size());
    }
    if (error < group.least_error) {
      group.least_error = error;
      group.best = point;
    }
    if (error > epsilon) continue;
    ++group.kept;
    sum += point.ability;
    squares += point.ability * point.ability;
    group.confirm_scale += point.confirm_gain * point.confirm_gain;
    group.correct_scale += point.correct_gain * point.correct_gain;
  }
  if (group.kept == 0) return group;
  const auto n = static_cast<double>(group.kept);
  group.ability_mean = sum / n;
  group.ability_sd = std::sqrt(std::max(squares / n - group.ability_mean * group.ability_mean, 0.0));
  group.confirm_scale = std::sqrt(group.confirm_scale / n);
  group.correct_scale = std::sqrt(group.correct_scale / n);
  return group;
}

}  // namespace

ParameterGrid published_grid() { return make_grid(0.55, 0.85, 7, 0.18, 10); }

std::vector<GridSearchGroup> grid_search(const ResponseLogs& logs, const LikelihoodTable& table, double epsilon) {
  if (!table.complete || !(epsilon > 0.0)) {
    throw std::invalid_argument{"grid_search: a complete table and epsilon > 0 are needed"};
  }
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < logs.people.size(); ++i) {
    if (logs.people[i].final_tests > 0) groups[logs.people[i].type].push_back(i);
  }
  if (logs.policy.empty() || groups.empty()) {
    auto fault = detail::fault("E0709",
                               "the grid search compares the final belief with final tests, and these logs do not have "
                               "both",
                               "", 0);
    fault.remedy = Remedy::kLikelihoodMethod;
    throw Error{{std::move(fault)}};
  }
  std::vector<GridSearchGroup> result;
  for (const auto& [name, people] : groups) {
    result.push_back(search(name.empty() ? "all" : name, people, logs, table, epsilon));
  }
  return result;
}

}  // namespace kith
