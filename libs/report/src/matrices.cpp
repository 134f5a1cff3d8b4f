#include "sections.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

#include "kith/analysis/moments.hpp"
#include "kith/analysis/team_difference.hpp"
#include "kith/files/column_names.hpp"
#include "outcomes.hpp"
#include "team_tables.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kFewestLevels = 3;

// What the study varies: its levels in the order of the tables, and which of them each team has.
struct Varied {
  std::string name;
  std::vector<std::string> levels{};
  std::vector<std::size_t> level_of_team{};
  bool has_own_people = true;  // of each level
  bool is_varied_key = false;
};

template <typename LevelOf>
Varied factor_of(const RunFiles& run, Varied factor, LevelOf level_of) {
  for (const auto& address : run.teams) {
    const std::string level = level_of(address);
    const auto found = std::find(factor.levels.begin(), factor.levels.end(), level);
    factor.level_of_team.push_back(static_cast<std::size_t>(found - factor.levels.begin()));
    if (found == factor.levels.end()) factor.levels.push_back(level);
  }
  return factor;
}

// Who is taught comes before how: the first of two factors has the rows.
std::vector<Varied> factors_of(const RunFiles& run) {
  std::vector<Varied> factors{
      factor_of(run, {.name = columns::kComposition}, [](auto& team) { return team.composition; })};
  for (std::size_t k = 0; k < run.spec().factors.size(); ++k) {
    factors.push_back(factor_of(run, {.name = run.spec().factors[k].key, .is_varied_key = true},
                                [&](auto& team) { return run.study.variants[team.variant].factors[k].value; }));
  }
  const bool own_people = run.spec().pairing != Pairing::kReplicate;
  factors.push_back(factor_of(run, {.name = columns::kStrategy, .has_own_people = own_people},
                              [](auto& team) { return team.strategy; }));
  return factors;
}

std::vector<StudyOutcome> outcomes_of(const RunData& data) {
  std::vector<StudyOutcome> all;
  for (const auto* column : data.has_exam ? std::array{columns::kExamRegret, columns::kExamShareRight}
                                          : std::array{columns::kKnowledge, columns::kPeriods})
    all.push_back(outcome_named(column));
  // A fixed number of periods, for instance, tells nothing.
  std::erase_if(all, [&](const StudyOutcome& outcome) {
    return std::all_of(data.teams.begin(), data.teams.end(),
                       [&](auto& team) { return outcome.of(team) == outcome.of(data.teams.front()); });
  });
  return all;
}

// The teams with one level of each of two factors, by who is in them.
using Teams = std::map<TeamPeople, std::vector<std::size_t>>;

class Matrix {
 public:
  Matrix(const RunFiles& run, const RunData& data, const Varied& rows, const Varied& columns)
      : data_{data}, rows_{rows}, columns_{columns}, cells_(rows.levels.size() * columns.levels.size()) {
    for (std::size_t i = 0; i < data.teams.size(); ++i) {
      const auto& address = run.teams[i];
      cells_[rows.level_of_team[i] * columns.levels.size() + columns.level_of_team[i]]
            [{address.composition, address.replicate}]
                .push_back(i);
    }
  }

  [[nodiscard]] Json table(const std::vector<StudyOutcome>& outcomes) const {
    std::vector<std::string> heads{rows_.name, columns_.name, "teams"};
    for (const auto& outcome : outcomes) {
      for (const auto* statistic : {"_mean", "_low", "_high", "_standing"})
        heads.push_back(std::string{outcome.column} + statistic);
    }
    JsonTable table{heads};
    for (std::size_t row = 0; row < rows_.levels.size(); ++row) {
      std::vector<std::vector<std::string>> standings;
      for (const auto& outcome : outcomes) standings.push_back(standings_in(row, outcome));
      for (std::size_t column = 0; column < columns_.levels.size(); ++column) {
        const auto& teams = at(row, column);
        if (teams.empty()) continue;  // an incomplete run
        const auto add = [](std::size_t sum, const auto& of_people) { return sum + of_people.second.size(); };
        auto cells = Json::array({rows_.levels[row], columns_.levels[column],
                                  std::accumulate(teams.begin(), teams.end(), std::size_t{0}, add)});
        for (std::size_t k = 0; k < outcomes.size(); ++k) {
          add_interval(cells, means_of_people(values_of(teams, outcomes[k])));
          cells.push_back(standings[k][column]);
        }
        table.add(std::move(cells));
      }
    }
    return std::move(table).take();
  }

 private:
  [[nodiscard]] const Teams& at(std::size_t row, std::size_t column) const {
    return cells_[row * columns_.levels.size() + column];
  }
  [[nodiscard]] TeamValues values_of(const Teams& teams, const StudyOutcome& outcome) const {
    TeamValues values;
    for (const auto& [people, all] : teams)
      for (const auto team : all) values[people].push_back(outcome.of(data_.teams[team]));
    return values;
  }

  [[nodiscard]] std::vector<std::string> standings_in(std::size_t row, const StudyOutcome& outcome) const {
    constexpr double kSlack = 1e-9;  // of sums in another order
    std::vector<std::string> standings(columns_.levels.size());
    std::vector<std::size_t> present;
    std::vector<double> costs(columns_.levels.size());
    for (std::size_t c = 0; c < costs.size(); ++c) {
      if (at(row, c).empty()) continue;
      present.push_back(c);
      costs[c] = (outcome.less_is_better ? 1.0 : -1.0) * mean(means_of_people(values_of(at(row, c), outcome)));
    }
    if (present.empty()) return standings;
    const auto best =
        *std::min_element(present.begin(), present.end(), [&](auto a, auto b) { return costs[a] < costs[b]; });
    for (const auto c : present) {
      if (costs[c] <= costs[best] + kSlack) {
        standings[c] = "best";
      } else if (includes_none(at(row, c), at(row, best), outcome)) {
        standings[c] = "not clearly worse";
      }
    }
    return standings;
  }

  // Whether the interval of the difference includes that there is none.
  [[nodiscard]] bool includes_none(const Teams& teams, const Teams& best, const StudyOutcome& outcome) const {
    const auto test =
        difference_of_teams(values_of(teams, outcome), values_of(best, outcome), !columns_.has_own_people).test;
    return test && test->low <= 0.0 && test->high >= 0.0;
  }

  const RunData& data_;
  const Varied& rows_;
  const Varied& columns_;
  std::vector<Teams> cells_;  // shape [rows, columns], row-major
};

}  // namespace

Json matrices(const RunFiles& run, const RunData& data) {
  Json all = Json::array();
  const auto outcomes = outcomes_of(data);
  if (outcomes.empty()) return all;
  Json described = Json::array();
  for (const auto& outcome : outcomes) described.push_back(outcome_json(outcome));

  const auto factors = factors_of(run);
  for (auto rows = factors.begin(); rows != factors.end(); ++rows) {
    for (auto columns = rows + 1; columns != factors.end(); ++columns) {
      if (!rows->is_varied_key && !columns->is_varied_key) continue;  // other figures are of these
      if (std::min(rows->levels.size(), columns->levels.size()) < kFewestLevels) continue;
      all.push_back({{"factors", {rows->name, columns->name}},
                     {"outcomes", described},
                     {"table", Matrix{run, data, *rows, *columns}.table(outcomes)}});
    }
  }
  return all;
}

}  // namespace kith::detail
