#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json_table.hpp"
#include "kith/core/error.hpp"
#include "kith/study/read_tables.hpp"
#include "kith/study/study_file.hpp"

namespace kith::detail {

// A finished run: what was run, and where its files are.
struct RunFiles {
  std::filesystem::path folder;
  Study study;
  Domain domain;
  TeamRegister teams;
  std::string study_toml;
  std::string domain_toml;
  Json manifest;

  [[nodiscard]] const StudySpec& spec() const { return study.variants.front(); }
  [[nodiscard]] const std::vector<LearnerType>& types() const { return spec().learner_types; }
};

// Checks that the folder is a finished run and reads what it says about itself.
// @throws kith::Error with E0601 to E0605.
[[nodiscard]] RunFiles open_run(const std::filesystem::path& folder);

// The text of one of the run's tables, such as "teams.csv". If it is not what the run wrote, a note is added.
// @throws kith::Error (kInvalidInput, E0604) if it is missing.
[[nodiscard]] std::string table_text(const RunFiles& run, const std::string& table, std::vector<std::string>& notes);

// Which fact of the manifest, as text; "" if it has none.
[[nodiscard]] std::string manifest_text(const RunFiles& run, const std::string& key);

// One complaint about a file of the run. @throws kith::Error.
[[noreturn]] void refuse_run(ErrorKind kind, const std::string& id, const std::filesystem::path& file,
                             const std::string& message, const std::string& hint);

}  // namespace kith::detail
