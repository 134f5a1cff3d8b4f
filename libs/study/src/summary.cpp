#include "kith/study/summary.hpp"

#include <cmath>
#include <vector>

namespace kith {
namespace detail {

// The values of the teams of one cell, gathered before anything is computed.
struct GatheredTeams {
  CellSummary cell;
  std::vector<double> periods, knowledge, area_sr;
  std::vector<double> person_periods, minutes, person_minutes;
  std::vector<double> share_right, regret, worst_share_right;  // of those that were examined
  std::vector<double> regret_before;                           // of those that were examined before the first lesson

  void add(const TeamRecord& team) {
    ++cell.teams;
    cell.completed += team.completed() ? 1u : 0u;
    cell.skipped += team.status == SessionStatus::kSkipped ? 1u : 0u;
    periods.push_back(static_cast<double>(team.periods));
    knowledge.push_back(team.knowledge);
    area_sr.push_back(team.area_sr);
    person_periods.push_back(static_cast<double>(team.cost.person_periods));
    minutes.push_back(team.cost.minutes);
    person_minutes.push_back(team.cost.person_minutes);
    cell.forecast = team.forecast;
    if (!team.exam) return;
    share_right.push_back(team.exam->share_right);
    regret.push_back(team.exam->regret);
    worst_share_right.push_back(team.exam->worst_share_right);
    double before = 0.0;
    std::size_t members = 0;
    for (const auto& row : team.exams) {
      if (row.period != 0 || row.component != 0) continue;
      before += row.regret;
      ++members;
    }
    // Teams that were examined at the end only have no rows of period 0, unless nothing was taught.
    if (members == team.learners.size() && members > 0) regret_before.push_back(before / static_cast<double>(members));
  }
  [[nodiscard]] bool contains(const TeamAddress& address) const {
    return cell.variant == address.variant && cell.strategy == address.strategy &&
           cell.composition == address.composition;
  }
};

}  // namespace detail

namespace {

using detail::GatheredTeams;
using Cells = std::vector<const GatheredTeams*>;

// Two passes: no cancellation. The values are those of the cells, one cell after the other.
MeanSd mean_sd(const Cells& cells, std::size_t n, std::vector<double> GatheredTeams::*values) {
  double sum = 0.0;
  for (const auto* cell : cells) {
    for (const double value : cell->*values) sum += value;
  }
  MeanSd result{sum / static_cast<double>(n), {}};
  if (n < 2) return result;
  double squares = 0.0;
  for (const auto* cell : cells) {
    for (const double value : cell->*values) squares += (value - result.mean) * (value - result.mean);
  }
  result.sd = std::sqrt(squares / (static_cast<double>(n) - 1.0));
  return result;
}

// All teams of these cells together, without saying which cells they are.
std::optional<CellSummary> pooled(const Cells& cells) {
  CellSummary summary;
  for (const auto* cell : cells) {
    summary.teams += cell->cell.teams;
    summary.completed += cell->cell.completed;
    summary.skipped += cell->cell.skipped;
  }

  if (summary.teams == 0) return std::nullopt;
  summary.periods = mean_sd(cells, summary.teams, &GatheredTeams::periods);
  summary.knowledge = mean_sd(cells, summary.teams, &GatheredTeams::knowledge);
  summary.area_sr = mean_sd(cells, summary.teams, &GatheredTeams::area_sr);
  summary.person_periods = mean_sd(cells, summary.teams, &GatheredTeams::person_periods);
  summary.minutes = mean_sd(cells, summary.teams, &GatheredTeams::minutes);
  summary.person_minutes = mean_sd(cells, summary.teams, &GatheredTeams::person_minutes);

  std::size_t examined = 0;
  for (const auto* cell : cells) examined += cell->share_right.size();
  if (examined == summary.teams) {
    summary.exam = ExamSummary{mean_sd(cells, examined, &GatheredTeams::share_right),
                               mean_sd(cells, examined, &GatheredTeams::regret),
                               mean_sd(cells, examined, &GatheredTeams::worst_share_right),
                               {}};
    std::size_t before = 0;
    for (const auto* cell : cells) before += cell->regret_before.size();
    if (before == summary.teams) summary.exam->regret_before = mean_sd(cells, before, &GatheredTeams::regret_before);
  }

  return summary;
}

}  // namespace

struct StudySummarizer::State {
  std::vector<GatheredTeams> cells;
};

StudySummarizer::StudySummarizer() : state_{std::make_unique<State>()} {}
StudySummarizer::~StudySummarizer() = default;
StudySummarizer::StudySummarizer(StudySummarizer&&) noexcept = default;
StudySummarizer& StudySummarizer::operator=(StudySummarizer&&) noexcept = default;

void StudySummarizer::add(const TeamRecord& team) {
  auto& cells = state_->cells;
  if (cells.empty() || !cells.back().contains(team.address)) {
    cells.emplace_back();
    cells.back().cell.variant = team.address.variant;
    cells.back().cell.strategy = team.address.strategy;
    cells.back().cell.composition = team.address.composition;
  }
  cells.back().add(team);
}

StudySummary StudySummarizer::summary() const {
  StudySummary summary;
  Cells group, baseline;
  for (const auto& cell : state_->cells) {
    auto one = *pooled({&cell});
    one.variant = cell.cell.variant;
    one.strategy = cell.cell.strategy;
    one.composition = cell.cell.composition;
    one.forecast = cell.cell.forecast;
    summary.cells.push_back(std::move(one));
    (cell.cell.strategy == kBaseline ? baseline : group).push_back(&cell);
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
