#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/study/study_file.hpp"
#include "scratch_folder.hpp"

namespace kith::testing {

/// The built-in study "quick", with overrides.
[[nodiscard]] inline StudyReading quick_study(const std::vector<std::string>& overrides = {}) {
  static const StudyReading kAsItIs = load_study("quick", {});
  auto reading = overrides.empty() ? kAsItIs : load_study("quick", {overrides});
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

/// The tables in a run folder, by name.
[[nodiscard]] inline std::map<std::string, std::string> tables_in(const std::filesystem::path& run) {
  std::map<std::string, std::string> tables;
  for (const auto& entry : std::filesystem::directory_iterator{run / "tables"}) {
    tables[entry.path().filename().string()] = read_file(entry.path());
  }
  return tables;
}

}  // namespace kith::testing
