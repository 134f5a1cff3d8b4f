#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// A whole design: one specification per setting of the varied factors (one without factors), otherwise alike.
struct Study {
  std::vector<StudySpec> variants;  ///< At least one.
};

/// The addresses of all teams in the order of the tables: by variant, strategy, composition, replicate.
[[nodiscard]] std::vector<TeamAddress> team_addresses(const Study& study);

struct RunOptions {
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never a result.
  /// Called now and then, from any thread, one call at a time, with the number of teams finished. Returning false
  /// stops the run after the teams under way.
  std::function<bool(std::size_t done, std::size_t total)> on_progress;
};

/// Simulates teams in parallel; result i is that of addresses[i], whatever the number of threads. Teams that were
/// not run because on_progress said stop are missing from the end result: the vector is then shorter and `stopped` set.
struct RunResult {
  std::vector<TeamRecord> teams;
  bool stopped = false;
};
[[nodiscard]] RunResult run_teams(const Atlas& atlas, const Study& study, std::span<const TeamAddress> addresses,
                                  const RunOptions& options = {});

}  // namespace kith
