#pragma once

#include <map>
#include <string>

#include "kith/study/run_folder.hpp"

namespace kith {

/// manifest.json of a run. @param tables  SHA-256 by file name.
[[nodiscard]] std::string manifest(const Study& study, std::size_t num_teams, const RunInputs& inputs,
                                   const std::map<std::string, std::string>& tables, const RunFacts& facts);

/// timings.csv of a run.
[[nodiscard]] std::string timings_table(const RunFacts& facts);

/// What /proc/cpuinfo calls the processor, or "unknown".
[[nodiscard]] std::string processor_name();

}  // namespace kith
