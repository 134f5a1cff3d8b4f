#pragma once

#include <memory>
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

/// The exams of teams at their end.
struct ExamSummary {
  MeanSd share_right;
  MeanSd regret;
  MeanSd worst_share_right;
  std::optional<MeanSd> regret_before;  ///< Before the first lesson, of ExamLevel::kPeriod.
};

/// What the teams of one cell, or of several pooled, came to.
struct CellSummary {
  std::size_t variant = 0;
  std::optional<std::string> strategy;  ///< Missing when pooled.
  std::string composition;              ///< Empty when pooled.
  std::size_t teams = 0;
  std::size_t completed = 0;
  std::size_t skipped = 0;  ///< Teams that left a component out because nothing that could be shown told anything.
  MeanSd periods;
  MeanSd knowledge;
  MeanSd area_sr;
  MeanSd person_periods;
  MeanSd minutes;  ///< By the study's pace, as TeamCost.
  MeanSd person_minutes;
  std::optional<TeamForecast> forecast;  ///< Of a cell, before the first lesson; missing when pooled.
  std::optional<ExamSummary> exam;       ///< If all teams were examined.
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
  StudySummarizer();
  ~StudySummarizer();
  StudySummarizer(const StudySummarizer&) = delete;
  StudySummarizer& operator=(const StudySummarizer&) = delete;
  StudySummarizer(StudySummarizer&&) noexcept;
  StudySummarizer& operator=(StudySummarizer&&) noexcept;
  void add(const TeamRecord& team);
  [[nodiscard]] StudySummary summary() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kith
