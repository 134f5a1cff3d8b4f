#include "sections.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/core/distributions.hpp"
#include "kith/files/column_names.hpp"
#include "team_tables.hpp"

namespace kith::detail {
namespace {

const Quantity kPeriodsOf = outcome_named(columns::kPeriods).of;

// The state of a team when so many periods were taught; its last one if it had fewer.
const ExamPoint& state_after(const std::vector<ExamPoint>& path, std::size_t periods) {
  return path[std::min(periods, path.size() - 1)];
}

// Periods by which 19 of 20 teams have ended: afterwards means hardly change.
std::size_t shown_periods(std::vector<std::size_t> lengths) {
  constexpr double kShare = 0.95;
  std::sort(lengths.begin(), lengths.end());
  return lengths[static_cast<std::size_t>(kShare * static_cast<double>(lengths.size() - 1))];
}

// Whether another strategy has at least as much for no more, and is better in one of both.
bool is_on_front(const std::vector<std::pair<double, double>>& all, std::size_t i) {
  return std::none_of(all.begin(), all.end(), [&](const auto& other) {
    return other.first <= all[i].first && other.second >= all[i].second &&
           (other.first < all[i].first || other.second > all[i].second);
  });
}

// Positions of the teams of every cell, by replicate.
std::vector<std::vector<std::size_t>> teams_of_cells(const ReportDesign& design) {
  std::vector<std::vector<std::size_t>> teams(design.cells.size());
  for (std::size_t i = 0; i < design.cell_of_team.size(); ++i) teams[design.cell_of_team[i]].push_back(i);
  return teams;
}

// What the front compares: knowledge, or the share right where the exam leads.
double known_at_end(const TeamRecord& team, const RunData& data) {
  return data.leads_with_exam ? team.exam->share_right : team.knowledge;
}

// How often each cell is on the front of its composition in bootstrap samples of the replicates, which all strategies
// share.
Values front_shares(const ReportDesign& design, const RunData& data, std::uint64_t seed) {
  constexpr std::size_t kSamples = 400;
  Values shares(design.cells.size(), 0.0);
  const auto teams = teams_of_cells(design);
  std::set<std::string> compositions;
  for (const auto& cell : design.cells) compositions.insert(cell.composition);

  for (const auto& composition : compositions) {
    std::vector<std::size_t> cells;
    std::size_t n = data.teams.size();
    for (std::size_t c = 0; c < design.cells.size(); ++c) {
      if (design.cells[c].composition != composition || teams[c].empty()) continue;
      cells.push_back(c);
      n = std::min(n, teams[c].size());
    }

    auto random = RandomStream{seed}.split("efficiency").split(composition);
    for (std::size_t sample = 0; sample < kSamples; ++sample) {
      // Of each cell the sums of items and knowledge: sums are on the front where means are.
      std::vector<std::pair<double, double>> means(cells.size());
      for (std::size_t k = 0; k < n; ++k) {
        const auto replicate = uniform_index(n, random);
        for (std::size_t c = 0; c < cells.size(); ++c) {
          const auto& team = data.teams[teams[cells[c]][replicate]];
          means[c].first += items_of(team);
          means[c].second += known_at_end(team, data);
        }
      }

      for (std::size_t c = 0; c < cells.size(); ++c) {
        if (is_on_front(means, c)) shares[cells[c]] += 1.0 / static_cast<double>(kSamples);
      }
    }
  }
  return shares;
}

Values values_of(const std::vector<std::size_t>& teams, const RunData& data,
                 const std::function<double(const TeamRecord&)>& quantity) {
  Values values;
  for (const auto team : teams) values.push_back(quantity(data.teams[team]));
  return values;
}

}  // namespace

Json exam_by_period_table(const ReportDesign& design, const RunData& data) {
  std::vector<std::string> columns{"strategy", "period", "teams", "items", "minutes", "person_minutes"};
  for (const std::string outcome : {"regret", "share_right", "worst_share_right", "knowledge"}) {
    columns.push_back(outcome);
    columns.push_back(outcome + "_low");
    columns.push_back(outcome + "_high");
  }
  JsonTable table{columns};

  for (std::size_t series = 0; series < design.series.size(); ++series) {
    std::vector<const std::vector<ExamPoint>*> paths;
    std::vector<std::size_t> lengths;
    for (std::size_t i = 0; i < data.exam_paths.size(); ++i) {
      if (design.cells[design.cell_of_team[i]].series != series || data.exam_paths[i].empty()) continue;
      paths.push_back(&data.exam_paths[i]);
      lengths.push_back(data.exam_paths[i].size() - 1);
    }
    if (paths.empty()) continue;

    const auto last = shown_periods(lengths);
    for (std::size_t period = 0; period <= last; ++period) {
      const auto values = [&](double ExamPoint::*value) {
        Values list;
        for (const auto* path : paths) list.push_back(state_after(*path, period).*value);
        return list;
      };

      auto row = Json::array({design.series[series].code, period, paths.size()});
      for (const auto cost : {&ExamPoint::items, &ExamPoint::minutes, &ExamPoint::person_minutes})
        row.push_back(number(mean(values(cost))));
      for (const auto outcome :
           {&ExamPoint::regret, &ExamPoint::share_right, &ExamPoint::worst_share_right, &ExamPoint::knowledge})
        add_interval(row, values(outcome));
      table.add(std::move(row));
    }
  }
  return std::move(table).take();
}

Json efficiency_table(const RunFiles& run, const ReportDesign& design, const RunData& data) {
  std::vector<std::string> columns{"strategy", "composition", "teams"};
  for (const std::string quantity : {"items", "minutes", "person_minutes", "knowledge", "share_right", "regret"}) {
    columns.push_back(quantity);
    columns.push_back(quantity + "_low");
    columns.push_back(quantity + "_high");
  }
  columns.insert(columns.end(), {"on_front", "front_share"});
  JsonTable table{columns};

  const auto teams = teams_of_cells(design);
  const auto shares = front_shares(design, data, run.spec().seed);
  for (std::size_t c = 0; c < design.cells.size(); ++c) {
    if (teams[c].empty()) continue;

    // Means of the cells with the same composition; `own` is the place of this one.
    std::vector<std::pair<double, double>> rivals;
    std::size_t own = 0;
    for (std::size_t other = 0; other < design.cells.size(); ++other) {
      if (design.cells[other].composition != design.cells[c].composition || teams[other].empty()) continue;
      if (other == c) own = rivals.size();
      rivals.emplace_back(
          mean(values_of(teams[other], data, items_of)),
          mean(values_of(teams[other], data, [&](const auto& team) { return known_at_end(team, data); })));
    }

    auto row = Json::array({design.series[design.cells[c].series].code, design.cells[c].composition, teams[c].size()});
    for (const Quantity quantity :
         {Quantity{items_of}, Quantity{[](auto& team) { return team.cost.minutes; }},
          Quantity{[](auto& team) { return team.cost.person_minutes; }}, outcome_named(columns::kKnowledge).of,
          outcome_named(columns::kExamShareRight).of, outcome_named(columns::kExamRegret).of})
      add_interval(row, values_of(teams[c], data, quantity));
    row.push_back(is_on_front(rivals, own));
    row.push_back(number(shares[c]));
    table.add(std::move(row));
  }
  return std::move(table).take();
}

Json forecasts_table(const ReportDesign& design, const RunData& data) {
  JsonTable table{{"strategy", "composition", "teams", "forecast_mean", "forecast_low", "forecast_high", "mean", "low",
                   "high", "within", "within_low", "within_high"}};
  const auto teams = teams_of_cells(design);
  for (std::size_t c = 0; c < design.cells.size(); ++c) {
    if (teams[c].empty() || !data.teams[teams[c].front()].forecast) continue;
    const auto& forecast = *data.teams[teams[c].front()].forecast;  // the same for the whole cell
    std::size_t within = 0;
    for (const auto team : teams[c]) {
      const double periods = kPeriodsOf(data.teams[team]);
      within += periods >= forecast.periods_low && periods <= forecast.periods_high ? 1u : 0u;
    }
    auto row = Json::array({design.series[design.cells[c].series].code, design.cells[c].composition, teams[c].size()});
    for (const double value : {forecast.periods, forecast.periods_low, forecast.periods_high})
      row.push_back(number(value));
    add_interval(row, values_of(teams[c], data, kPeriodsOf));
    const auto share = wilson_interval(within, teams[c].size());
    for (const double value : {share.estimate, share.low, share.high}) row.push_back(number(value));
    table.add(std::move(row));
  }
  return std::move(table).take();
}

Json forecast_calibration_table(const RunData& data) {
  JsonTable table{{"within", "forecast", "share", "low", "high", "n"}};
  for (std::size_t k = 0; k < data.calibration.size(); ++k) {
    for (const auto& bin : data.calibration[k]) {
      if (bin.n == 0) continue;
      const auto share = wilson_interval(bin.done, bin.n);
      auto row = Json::array({k + 1, number(bin.predicted / static_cast<double>(bin.n))});
      for (const double value : {share.estimate, share.low, share.high}) row.push_back(number(value));
      row.push_back(bin.n);
      table.add(std::move(row));
    }
  }
  return std::move(table).take();
}

}  // namespace kith::detail
