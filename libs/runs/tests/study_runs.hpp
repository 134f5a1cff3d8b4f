#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/runs/study_run.hpp"
#include "run_support.hpp"

namespace kith::testing {

using Tables = std::map<std::string, std::string>;

/// Options of a run by a program of its own, which saves every team for itself.
inline StudyRunOptions how() {
  StudyRunOptions options;
  options.program = "kith test";
  options.threads = 2;
  options.checkpoint_seconds = 0.0;
  return options;
}

/// What the study's tables are when nothing happens.
inline const Tables& expected() {
  static const Tables kTables = [] {
    const ScratchFolder scratch;
    const auto reading = quick_study();
    const auto result = run_teams(item_delivery(), *reading.study, team_addresses(*reading.study));
    RunFolder{scratch.path() / "run", freeze(reading)}.publish(*reading.study, result.teams, {});
    return tables_in(scratch.path() / "run");
  }();
  return kTables;
}

/// Runs it to the end and returns the tables.
inline Tables run(const std::filesystem::path& folder, StudyRunOptions options = how()) {
  StudyRun run{folder, quick_study(), std::move(options)};
  EXPECT_TRUE(run.teach(item_delivery()));
  (void)run.publish({});
  return tables_in(folder);
}

/// Stops it once so many teams are finished.
inline void run_partly(const std::filesystem::path& folder, std::size_t teams, StudyRunOptions options = how()) {
  std::atomic<bool> stop{false};
  options.threads = 1;
  options.on_progress = [&](std::size_t done, std::size_t, std::size_t) { stop = stop || done >= teams; };
  options.stopped = [&] { return stop.load(); };
  StudyRun run{folder, quick_study(), std::move(options)};
  EXPECT_FALSE(run.teach(item_delivery()));
  EXPECT_EQ(run.num_done(), teams);
}

/// What is thrown.
inline Error failure_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return Error{ErrorKind::kUsage, ""};
}

[[nodiscard]] inline ErrorKind kind_of_failure(const std::function<void()>& action) {
  return failure_of(action).kind();
}

/// A folder for a run of the study "quick".
class StudyRunTest : public ::testing::Test {
 protected:
  ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path() / "run";
};

}  // namespace kith::testing
