#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kith/study/records.hpp"
#include "kith/study/study_file.hpp"

namespace kith {

/// The frozen inputs of a run: all that its tables follow from, together with the
/// program. Two runs are of the same study iff these are equal.
struct RunInputs {
  std::string study;   ///< The resolved study file, every key written out; its domain is "domain.toml".
  std::string domain;  ///< The text of the domain file.
  friend bool operator==(const RunInputs&, const RunInputs&) = default;
};
/// @pre the reading has a study.
[[nodiscard]] RunInputs freeze(const StudyReading& reading);

/// What the manifest says besides hashes: facts about a run that no table depends on.
struct RunFacts {
  std::string version;
  std::string git;
  bool dirty = false;
  std::string compiler;
  std::string build_type;
  std::string flags;
  std::vector<std::string> command_line;
  std::size_t threads = 0;
  std::string domain;   ///< As the study names it.
  std::string started;  ///< UTC, "2026-01-31T12:00:00Z".
  std::string stopped;
  std::vector<std::pair<std::string, double>> timings;  ///< Phase and seconds, for timings.csv.
  std::vector<std::string> log;                         ///< Lines of log.txt.
};

/// The folder that a study's results go to:
///
///   manifest.json    what was run, by which build, and hashes of inputs and tables
///   inputs/          study.toml and domain.toml, frozen
///   tables/          teams.csv and the others (tables.hpp), codebook.json
///   timings.csv, log.txt
///
/// Results appear complete or not at all: tables are written aside and put in
/// place in one step. Until publish() nothing that was there changes. The folder is locked
/// while the object lives. Errors are kith::Error.
class RunFolder {
 public:
  /// Makes the folder if there is none, and locks it.
  /// @param replace  whether it may hold the results of another study, which are then replaced.
  /// @throws kith::Error kIo if it cannot be written, kBusy if another process has locked it, kUsage if it holds
  /// another study's results or is no run folder (unless `replace`).
  RunFolder(std::filesystem::path path, RunInputs inputs, bool replace = false);
  /// A folder that was made here and got no results is removed.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Whether results of the same study were there before.
  [[nodiscard]] bool has_results() const noexcept { return has_results_; }

  /// Writes everything. @throws kith::Error (kIo); then what was there before is still there.
  void publish(const Study& study, std::span<const TeamRecord> teams, const RunFacts& facts);

 private:
  void lock();
  void check_content(bool replace);

  std::filesystem::path path_;
  std::filesystem::path staging_;
  RunInputs inputs_;
  int descriptor_ = -1;
  bool made_ = false;
  bool has_results_ = false;
  bool published_ = false;
};

/// The study of a finished run, from its frozen inputs.
/// @throws kith::Error kIo if the folder is no run folder.
[[nodiscard]] StudyReading read_run_folder(const std::filesystem::path& path);

}  // namespace kith
