#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json_table.hpp"
#include "kith/files/published_run.hpp"
#include "kith/study/study.hpp"
#include "kith/study/study_file.hpp"

namespace kith::detail {

// A finished run: what was run, and where its files are.
struct RunFiles {
  std::filesystem::path folder;
  Study study;
  Domain domain;
  std::vector<TeamAddress> teams;  // that the tables hold
  std::string study_toml;
  std::string domain_toml;
  Json manifest;
  PublishedRun published;

  [[nodiscard]] const StudySpec& spec() const { return study.variants.front(); }
  [[nodiscard]] const std::vector<LearnerType>& types() const { return spec().learner_types; }
};

// Checks that the folder is a finished run and reads what it says about itself.
// @throws kith::Error as PublishedRun::open() does.
[[nodiscard]] RunFiles open_run(const std::filesystem::path& folder, const StudyKinds& kinds);

// The text of one of the run's tables, such as "teams.csv". @throws kith::Error as PublishedRun::read() does.
[[nodiscard]] std::string table_text(const RunFiles& run, const std::string& table);

// Which fact of the manifest, as text; "" if it has none.
[[nodiscard]] std::string manifest_text(const RunFiles& run, const std::string& key);

}  // namespace kith::detail
