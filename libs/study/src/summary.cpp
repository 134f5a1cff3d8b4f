#include "kith/study/summary.hpp"

#include <algorithm>
#include <cmath>

namespace kith {
namespace {

// The values of one cell, gathered before anything is computed.
struct Gathered {
  CellSummary cell;
  std::vector<double> periods, knowledge, area_sr;

  void add(const TeamRecord& team) {
    ++cell.teams;
    cell.completed += team.completed ? 1u : 0u;
    periods.push_back(static_cast<double>(team.periods));
    knowledge.push_back(team.knowledge);
    area_sr.push_back(team.area_sr);
  }
};

// Two passes: no cancellation. @pre values is not empty.
MeanSd mean_sd(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  MeanSd result{sum / n, {}};
  if (values.size() < 2) return result;
  double squares = 0.0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.sd = std::sqrt(squares / (n - 1.0));
  return result;
}

std::optional<CellSummary> finish(Gathered gathered) {
  if (gathered.cell.teams == 0) return std::nullopt;
  gathered.cell.periods = mean_sd(gathered.periods);
  gathered.cell.knowledge = mean_sd(gathered.knowledge);
  gathered.cell.area_sr = mean_sd(gathered.area_sr);
  return gathered.cell;
}

}  // namespace

StudySummary summarize(std::span<const TeamRecord> teams) {
  std::vector<Gathered> cells;
  Gathered group, baseline;
  for (const auto& team : teams) {
    const auto& address = team.address;
    const bool same = !cells.empty() && cells.back().cell.variant == address.variant &&
                      cells.back().cell.strategy == address.strategy &&
                      cells.back().cell.composition == address.composition;
    if (!same) {
      cells.emplace_back();
      cells.back().cell.variant = address.variant;
      cells.back().cell.strategy = address.strategy;
      cells.back().cell.composition = address.composition;
    }
    cells.back().add(team);
    (address.strategy == Strategy::kBaseline ? baseline : group).add(team);
  }
  StudySummary summary;
  for (auto& cell : cells) summary.cells.push_back(*finish(std::move(cell)));
  summary.group = finish(std::move(group));
  summary.baseline = finish(std::move(baseline));
  return summary;
}

}  // namespace kith
