#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kith/runs/run_folder.hpp"

namespace kith {

/// What a run has come to, for its manifest.
struct RunContent {
  const RunInputs& inputs;
  std::size_t teams = 0;
  std::string shard = {};                          ///< Such as "2/3"; empty for a whole study.
  std::map<std::string, std::string> tables = {};  ///< SHA-256 by file name.
  std::vector<std::string> grown = {};             ///< What was published of it before teams were added, in words.
};

/// manifest.json of a run.
[[nodiscard]] std::string manifest(const Study& study, const RunContent& content, const RunFacts& facts);

/// The text that a manifest has under `key` ("run": the digest of the inputs); nothing if it has none, or if the
/// manifest is not as it was written.
[[nodiscard]] std::optional<std::string> fact_in_manifest(const std::string& manifest, const std::string& key);

/// RunContent::grown of a run that replaces the one with the manifest `before`: what that one says, and it itself if it
/// is of the same study with fewer teams (`is_part`).
[[nodiscard]] std::vector<std::string> growth_of(const std::string& before, const RunInputs& now, bool is_part);

/// timings.csv of a run.
[[nodiscard]] std::string timings_table(const RunFacts& facts);

/// What /proc/cpuinfo calls the processor, or "unknown".
[[nodiscard]] std::string processor_name();

}  // namespace kith
