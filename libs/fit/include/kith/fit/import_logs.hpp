#pragma once

#include <filesystem>
#include <vector>

#include "kith/fit/accuracy.hpp"
#include "kith/fit/person_log.hpp"

namespace kith {

/// What some logs hold: people with what they saw, or only who answered what.
struct ImportedLogs {
  ResponseLogs logs;                     ///< Empty if there are only records.
  std::vector<AccuracyRecord> accuracy;  ///< Of data without exposures.
};

/// Reads logs of any known layout and puts them together: run folders (import_run_folder()), CSV files with one row per
/// trial (import_trials()), and the folder or the response table of the 2021 study (read_lee2021_responses()). With
/// more than one log, people are named after it: "2:7/1".
/// @throws kith::Error as the importers do; E0703 for anything else, and if data with and without exposures are mixed.
[[nodiscard]] ImportedLogs import_logs(const std::vector<std::filesystem::path>& paths, AnswerDetail detail,
                                       PeopleRead people = PeopleRead::kBayesian);

}  // namespace kith
