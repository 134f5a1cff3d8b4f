#include "team_tables.hpp"

#include <span>
#include <utility>

#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/analysis/survival.hpp"
#include "kith/files/column_names.hpp"

namespace kith::detail {
namespace {

void add_ends(Json& row, std::span<const double> values) {
  const auto interval = mean_interval(values);
  row.push_back(interval ? number(interval->low) : Json(nullptr));
  row.push_back(interval ? number(interval->high) : Json(nullptr));
}

Json cell_keys(const ReportDesign& design, std::size_t cell) {
  return Json::array({design.series[design.cells[cell].series].code, design.cells[cell].composition});
}

}  // namespace

std::vector<Values> by_cell(const ReportDesign& design, const RunData& data, Quantity quantity) {
  std::vector<Values> result(design.cells.size());
  for (std::size_t i = 0; i < data.teams.size(); ++i) result[design.cell_of_team[i]].push_back(quantity(data.teams[i]));
  return result;
}

void add_interval(Json& row, std::span<const double> values) {
  row.push_back(number(mean(values)));
  add_ends(row, values);
}

Json cells_table(const ReportDesign& design, const RunData& data) {
  std::vector<std::string> columns{"strategy", "composition", "teams", "completed"};
  std::vector<std::pair<std::string, Quantity>> shown;
  for (const auto& outcome : outcomes()) {
    if (outcome.column == columns::kCompleted || (outcome.needs_exam && !data.has_exam)) continue;
    shown.emplace_back(outcome.column == columns::kAreaSr ? "area" : outcome.column, outcome.of);
  }
  for (const auto& [name, of] : shown) {
    for (const auto* statistic : {"_mean", "_sd", "_low", "_high"}) columns.push_back(name + statistic);
  }
  JsonTable table{columns};

  std::vector<std::size_t> completed(design.cells.size());
  for (std::size_t i = 0; i < data.teams.size(); ++i) {
    if (data.teams[i].completed()) ++completed[design.cell_of_team[i]];
  }

  std::vector<std::vector<Values>> quantities;
  for (const auto& [name, of] : shown) quantities.push_back(by_cell(design, data, of));

  for (std::size_t cell = 0; cell < design.cells.size(); ++cell) {
    auto row = cell_keys(design, cell);
    row.push_back(design.cells[cell].teams);
    row.push_back(completed[cell]);
    for (const auto& quantity : quantities) {
      row.push_back(number(mean(quantity[cell])));
      row.push_back(number(standard_deviation(quantity[cell])));
      add_ends(row, quantity[cell]);
    }
    table.add(std::move(row));
  }
  return std::move(table).take();
}

Json teams_table(const RunFiles& run, const ReportDesign& design, const RunData& data, std::size_t points) {
  std::vector<std::string> columns{"strategy", "composition", "replicate", "team", "periods", "knowledge", "completed"};
  std::vector<const StudyOutcome*> of_exam;
  for (const auto& outcome : outcomes()) {
    if (!outcome.needs_exam || !data.has_exam) continue;
    of_exam.push_back(&outcome);
    columns.emplace_back(outcome.column);
  }
  JsonTable table{columns};
  for (std::size_t i = 0; i < data.teams.size(); ++i) {
    const auto& address = run.teams[i];
    if (address.replicate > points) continue;  // replicates are exchangeable: the first ones are as good as any
    auto row = cell_keys(design, design.cell_of_team[i]);
    row.push_back(address.replicate);
    row.push_back(address.team);
    row.push_back(data.teams[i].periods);
    row.push_back(number(data.teams[i].knowledge));
    row.push_back(data.teams[i].completed());
    for (const auto* outcome : of_exam) row.push_back(number(outcome->of(data.teams[i])));
    table.add(std::move(row));
  }
  return std::move(table).take();
}

Json completion_table(const ReportDesign& design, const RunData& data) {
  JsonTable table{{"strategy", "composition", "period", "done", "low", "high", "at_risk"}};
  std::vector<Values> times(design.cells.size());
  std::vector<std::vector<bool>> observed(design.cells.size());
  for (std::size_t i = 0; i < data.teams.size(); ++i) {
    // A team to which nothing had to be taught is done at 0; survival times must be positive.
    times[design.cell_of_team[i]].push_back(static_cast<double>(data.teams[i].periods) + 1.0);
    observed[design.cell_of_team[i]].push_back(data.teams[i].completed());
  }
  for (std::size_t cell = 0; cell < design.cells.size(); ++cell) {
    const auto curve = kaplan_meier(times[cell], observed[cell]);
    const auto add = [&](double time, double done, double low, double high, std::size_t at_risk) {
      auto row = cell_keys(design, cell);
      row.push_back(static_cast<std::size_t>(time) - 1);
      for (const double value : {done, low, high}) row.push_back(number(value));
      row.push_back(at_risk);
      table.add(std::move(row));
    };
    if (curve.steps.empty() || curve.steps.front().time > 1.0) add(1.0, 0.0, 0.0, 0.0, times[cell].size());
    for (const auto& step : curve.steps) {
      add(step.time, 1.0 - step.survival, 1.0 - step.high, 1.0 - step.low, step.at_risk);
    }
  }
  return std::move(table).take();
}

Json area_table(const ReportDesign& design, const RunData& data) {
  JsonTable table{{"strategy", "kc", "mean_log_area", "low", "high", "mean_area_sr", "n"}};
  for (std::size_t series = 0; series < design.series.size(); ++series) {
    for (std::size_t kc = 0; kc < data.num_components; ++kc) {
      Values logs, areas;  // one value per team: its periods are not independent of each other
      for (std::size_t i = 0; i < data.teams.size(); ++i) {
        const auto& values = data.components[i * data.num_components + kc];
        if (design.cells[design.cell_of_team[i]].series != series || values.later_periods == 0) continue;
        logs.push_back(values.log_area_sum / static_cast<double>(values.later_periods));
        areas.push_back(values.area_sum / static_cast<double>(values.later_periods));
      }
      if (logs.empty()) continue;
      auto row = Json::array({design.series[series].code, kc + 1});
      add_interval(row, logs);
      row.push_back(number(mean(areas)));
      row.push_back(logs.size());
      table.add(std::move(row));
    }
  }
  return std::move(table).take();
}

Json periods_by_component_table(const ReportDesign& design, const RunData& data) {
  JsonTable table{{"strategy", "composition", "kc", "mean_periods", "low", "high"}};
  for (std::size_t kc = 0; kc < data.num_components; ++kc) {
    std::vector<Values> values(design.cells.size());
    for (std::size_t i = 0; i < data.teams.size(); ++i) {
      values[design.cell_of_team[i]].push_back(
          static_cast<double>(data.components[i * data.num_components + kc].periods));
    }
    for (std::size_t cell = 0; cell < design.cells.size(); ++cell) {
      auto row = cell_keys(design, cell);
      row.push_back(kc + 1);
      add_interval(row, values[cell]);
      table.add(std::move(row));
    }
  }
  return std::move(table).take();
}

}  // namespace kith::detail
