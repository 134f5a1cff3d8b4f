#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/study/study.hpp"

namespace kith {

/// Mean and sample standard deviation (n - 1); the latter missing below two values.
struct MeanSd {
  double mean = 0.0;
  std::optional<double> sd;
};

/// What the teams of one cell, or of several pooled, came to.
struct CellSummary {
  std::size_t variant = 0;
  std::optional<std::string> strategy;  ///< Missing when pooled.
  std::string composition;              ///< Empty when pooled.
  std::size_t teams = 0;
  std::size_t completed = 0;
  std::size_t skipped = 0;  ///< Teams that left a component out because nothing that could be shown told anything.
  std::optional<TeamForecast> forecast{};  ///< Of a cell, before the first lesson; missing when pooled.
  // Of all teams; missing if some have no value.
  std::optional<MeanSd> periods{}, knowledge{}, area_sr{};
  std::optional<MeanSd> person_periods{}, minutes{}, person_minutes{};  ///< By the study's pace, as TeamCost.
  std::optional<MeanSd> share_right{}, regret{}, worst_share_right{};   ///< In the exam at the end.
  std::optional<MeanSd> regret_before{};  ///< Before the first lesson, of ExamLevel::kPeriod.
};

/// Per cell in the order of the tables, and pooled over the group strategies and over the baseline.
struct StudySummary {
  std::vector<CellSummary> cells;
  std::optional<CellSummary> group;  ///< All strategies but the baseline; missing if there is none.
  std::optional<CellSummary> baseline;
};
[[nodiscard]] StudySummary summarize(std::span<const TeamRecord> teams);

/// The same for teams that come one by one, in the order of the tables: keeps a few numbers of each.
class StudySummarizer {
 public:
  void add(const TeamRecord& team);
  [[nodiscard]] StudySummary summary() const;

 private:
  struct Cell {
    CellSummary summary;
    std::vector<std::vector<double>> values;  // of every measure, of the teams that have it
  };
  [[nodiscard]] static std::optional<CellSummary> pooled(const std::vector<const Cell*>& cells);
  std::vector<Cell> cells_;
};

}  // namespace kith
