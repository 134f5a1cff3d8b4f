#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study_spec.hpp"
#include "kith/study/work_counter.hpp"

namespace kith {

/// A whole design: one specification per setting of the varied factors (one without factors), otherwise alike.
struct Study {
  std::vector<StudySpec> variants;  ///< At least one.
};

/// The most teams that a study may have.
inline constexpr std::size_t kMaxTeams = 10'000'000;

/// Teams of the whole study: the numbers of teams are 1 to this.
[[nodiscard]] std::size_t num_teams(const Study& study);
/// The address of a team from its number. Teams are numbered by variant, strategy, composition, replicate.
/// @throws std::invalid_argument if there is no such team.
[[nodiscard]] TeamAddress team_address(const Study& study, std::size_t team);
/// The addresses of all teams in the order of their numbers, which is that of the tables.
[[nodiscard]] std::vector<TeamAddress> team_addresses(const Study& study);
/// As people read it: "team 17 (joint, NNP, replicate 2)"; with the settings of varied factors.
[[nodiscard]] std::string describe_team(const Study& study, const TeamAddress& address);

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

/// What came of one team: a record, or why there is none.
struct TeamOutcome {
  std::size_t position = 0;  ///< In the list of teams.
  TeamAddress address;
  std::optional<TeamRecord> record;
  std::exception_ptr failure;
};

struct StreamOptions {
  std::size_t threads = 0;         ///< 0: as many as there are cores.
  WorkCounter* counter = nullptr;  ///< Shared with those who teach other teams of the same list; null: all are ours.
  std::size_t chunk = 1;           ///< Teams taken from the counter at a time.
  /// Asked by every thread once a period; once true, teams under way are given up. May be empty.
  std::function<bool()> stopped;
};

/// Simulates teams in parallel and hands each to `sink` as soon as it is finished, from any thread and several at a
/// time; nothing is kept. What a team comes to depends on its address alone, so neither the order nor who else takes
/// from the counter changes a record.
/// @param teams  numbers, in the order in which they are begun.
/// @throws what `sink` throws, once the teams under way are finished; no further team is begun then.
void stream_teams(const Atlas& atlas, const Study& study, std::span<const std::uint32_t> teams,
                  const StreamOptions& options, const std::function<void(TeamOutcome outcome)>& sink);

}  // namespace kith
