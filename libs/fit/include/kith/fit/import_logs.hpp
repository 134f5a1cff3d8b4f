#pragma once

#include <filesystem>
#include <vector>

#include "kith/fit/person_log.hpp"

namespace kith {

/// Reads logs of any known layout and puts them together: run folders (import_run_folder()) and CSV files with one row
/// per trial (import_trials()). With more than one log, people are named after it: "2:7/1".
/// @throws kith::Error as the importers do; E0703 for anything else.
[[nodiscard]] ResponseLogs import_logs(const std::vector<std::filesystem::path>& paths, AnswerDetail detail);

}  // namespace kith
