#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "console.hpp"
#include "kith/runs/study_run.hpp"

namespace kith::cli {

/// Where a run goes, when it began, and how many features its domain has.
struct RunPlace {
  std::string folder;
  std::chrono::steady_clock::time_point begin;
  std::size_t num_features = 0;
};

/// Says which teams failed, and why.
void report_failures(const Study& study, const std::vector<TeamFailure>& failures, Console& console);

/// Publishes the tables of a run that has come to its end, and prints what came out. @return the exit code.
int publish_run(StudyRun& run, RunFacts facts, const RunPlace& place, Console& console);

}  // namespace kith::cli
