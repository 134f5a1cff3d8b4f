#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "design.hpp"
#include "kith/analysis/dataset.hpp"
#include "run_data.hpp"

namespace kith::detail {

// A group of live sessions that was taught.
struct LiveGroup {
  std::string session;  // id of the room
  std::string strategy;
  std::string composition;
  std::size_t replicate = 0;
  std::size_t people = 0;  // members who began as people
  bool completed = false;
  std::size_t periods = 0;
  std::optional<double> knowledge;  // the teacher's estimate
  std::string ended;                // why, if it ended before its time
};

// Tables of an export of live sessions.
struct SessionTables {
  std::filesystem::path folder;
  Json about;  // study.json
  std::map<std::string, std::string> hashes;
  std::vector<LiveGroup> groups;  // in the order of the design
  std::size_t num_waiting = 0;    // groups that were never taught
  Dataset sessions, participants, periods, tests, beliefs;

  // Position of a group; nothing for rooms that were not taught.
  [[nodiscard]] std::optional<std::size_t> group_of(const std::string& session) const;
};

// Whether the folder is an export of live sessions.
[[nodiscard]] bool is_session_export(const std::filesystem::path& folder);

// Checks every file against SHA256SUMS and reads the tables.
// @throws kith::Error kInvalidInput E0604 (a table is missing), kMismatch E0607 (a file is another one) and those of
// Dataset::parse().
[[nodiscard]] SessionTables read_session_tables(const std::filesystem::path& folder);

}  // namespace kith::detail
