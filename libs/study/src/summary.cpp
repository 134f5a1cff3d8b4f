#include "kith/study/summary.hpp"

#include <array>
#include <cmath>

namespace kith {
namespace {

using Figure = std::optional<double>;

// A value of a team, and where its mean goes.
struct Measure {
  std::optional<MeanSd> CellSummary::*mean;
  Figure (*of)(const TeamRecord& team);
};

template <double TeamExam::*member>
Figure in_exam(const TeamRecord& team) {
  return team.exam ? Figure{(*team.exam).*member} : std::nullopt;
}

// Teams that were examined at the end only have no rows of period 0, unless nothing was taught.
Figure regret_before(const TeamRecord& team) {
  double sum = 0.0;
  std::size_t members = 0;
  for (const auto& row : team.exams) {
    if (row.period != 0 || row.component != 0) continue;
    sum += row.regret;
    ++members;
  }
  if (!team.exam || members != team.learners.size() || members == 0) return std::nullopt;
  return sum / static_cast<double>(members);
}

constexpr std::array kMeasures{
    Measure{&CellSummary::periods, [](const TeamRecord& team) { return Figure{static_cast<double>(team.periods)}; }},
    Measure{&CellSummary::knowledge, [](const TeamRecord& team) { return Figure{team.knowledge}; }},
    Measure{&CellSummary::area_sr, [](const TeamRecord& team) { return Figure{team.area_sr}; }},
    Measure{&CellSummary::person_periods,
            [](const TeamRecord& team) { return Figure{static_cast<double>(team.cost.person_periods)}; }},
    Measure{&CellSummary::minutes, [](const TeamRecord& team) { return Figure{team.cost.minutes}; }},
    Measure{&CellSummary::person_minutes, [](const TeamRecord& team) { return Figure{team.cost.person_minutes}; }},
    Measure{&CellSummary::share_right, in_exam<&TeamExam::share_right>},
    Measure{&CellSummary::regret, in_exam<&TeamExam::regret>},
    Measure{&CellSummary::worst_share_right, in_exam<&TeamExam::worst_share_right>},
    Measure{&CellSummary::regret_before, regret_before},
};

// Two passes: no cancellation.
MeanSd mean_sd(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  MeanSd result{sum / n, {}};
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  if (values.size() > 1) result.sd = std::sqrt(squares / (n - 1.0));
  return result;
}

}  // namespace

void StudySummarizer::add(const TeamRecord& team) {
  const auto& address = team.address;
  const auto is_of = [&](const CellSummary& cell) {
    return cell.variant == address.variant && cell.strategy == address.strategy &&
           cell.composition == address.composition;
  };
  if (cells_.empty() || !is_of(cells_.back().summary)) {
    cells_.push_back({{.variant = address.variant, .strategy = address.strategy, .composition = address.composition},
                      std::vector<std::vector<double>>(kMeasures.size())});
  }
  auto& [cell, values] = cells_.back();
  ++cell.teams;
  cell.completed += team.completed() ? 1u : 0u;
  cell.skipped += team.status == SessionStatus::kSkipped ? 1u : 0u;
  cell.forecast = team.forecast;
  for (std::size_t m = 0; m < kMeasures.size(); ++m) {
    if (const auto value = kMeasures[m].of(team)) values[m].push_back(*value);
  }
}

// All teams of these cells together, without saying which cells they are.
std::optional<CellSummary> StudySummarizer::pooled(const std::vector<const Cell*>& cells) {
  CellSummary summary;
  for (const auto* cell : cells) {
    summary.teams += cell->summary.teams;
    summary.completed += cell->summary.completed;
    summary.skipped += cell->summary.skipped;
  }
  if (summary.teams == 0) return std::nullopt;
  for (std::size_t m = 0; m < kMeasures.size(); ++m) {
    std::vector<double> values;
    for (const auto* cell : cells) values.insert(values.end(), cell->values[m].begin(), cell->values[m].end());
    if (values.size() == summary.teams) summary.*kMeasures[m].mean = mean_sd(values);
  }
  return summary;
}

StudySummary StudySummarizer::summary() const {
  StudySummary summary;
  std::vector<const Cell*> group, baseline;
  for (const auto& cell : cells_) {
    auto& one = summary.cells.emplace_back(*pooled({&cell}));
    one.variant = cell.summary.variant;
    one.strategy = cell.summary.strategy;
    one.composition = cell.summary.composition;
    one.forecast = cell.summary.forecast;
    (one.strategy == kBaseline ? baseline : group).push_back(&cell);
  }
  summary.group = pooled(group);
  summary.baseline = pooled(baseline);
  return summary;
}

StudySummary summarize(std::span<const TeamRecord> teams) {
  StudySummarizer summarizer;
  for (const auto& team : teams) summarizer.add(team);
  return summarizer.summary();
}

}  // namespace kith
