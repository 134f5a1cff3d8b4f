#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kith/files/folder_lock.hpp"
#include "kith/files/generation.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"

namespace kith {

/// A file that the domain file names, frozen.
struct InputFile {
  std::string name;    ///< As the domain file says it, so it is found beside the frozen domain file.
  std::string sha256;  ///< Of the text.
  std::string text;    ///< Empty if only the hash is known.
  friend bool operator==(const InputFile& a, const InputFile& b) { return a.name == b.name && a.sha256 == b.sha256; }
};

/// The frozen inputs of a run: all that its tables follow from, together with the
/// program. Two runs are of the same study iff these are equal.
struct RunInputs {
  std::string study;                  ///< The resolved study file, every key written out, in a fixed order; its domain
                                      ///< is "domain.toml".
  std::string domain;                 ///< The text of the domain file.
  std::vector<InputFile> files = {};  ///< Those that it names, equal iff their hashes are.
  friend bool operator==(const RunInputs&, const RunInputs&) = default;

  /// SHA-256 of all of it, as 64 hexadecimal digits: the identity of what was asked. It stands in the journal, in every
  /// record's checksum, in the codebook beside the tables and in the manifest.
  [[nodiscard]] std::string digest() const;
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
  std::size_t threads = 0;  ///< Of every rank.
  std::size_t ranks = 1;
  std::string domain;   ///< As the study names it.
  std::string started;  ///< UTC, "2026-01-31T12:00:00Z".
  std::string stopped;
  std::vector<std::pair<std::string, double>> timings;  ///< Phase and seconds, for timings.csv.
  std::vector<std::string> log;                         ///< Lines of log.txt.
  std::vector<std::string> failed;                      ///< Teams that could not be taught, described.
  std::vector<std::string> missing;                     ///< What is missing for other reasons, in words.
};

/// The folder that a study's results go to:
///
///   manifest.json    what was run, by which build, and hashes of inputs and tables
///   inputs/          study.toml, domain.toml and the files that it names, frozen
///   study.sqlite     the journal (journal.hpp)
///   tables/          teams.csv and the others (tables.hpp), codebook.json
///   timings.csv, log.txt
///
/// Inputs, tables and manifest change together, in one step (Generation). Until publish() nothing that was there
/// changes. The folder is locked while the object lives. Errors are kith::Error.
class RunFolder {
 public:
  /// Makes the folder if there is none, locks it, and finishes a publication that was interrupted.
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
  /// @throws kith::Error (kIo) unless the folder is still where it was.
  void require_in_place() const;

  /// Writes the inputs now, unless those of another study are there, which stay until publish().
  void freeze_inputs();
  /// Removes the journal and, if the folder was made here, the inputs: as if nothing had begun.
  void discard();
  /// Writes everything. @throws kith::Error (kIo); then what was there before is still there.
  void publish(const Study& study, std::span<const TeamRecord> teams, const RunFacts& facts);
  /// The same for teams that come one by one; none is kept.
  void publish(const Study& study, const TeamSource& teams, const RunFacts& facts);
  /// Writes the inputs and a manifest that says which shard this is, such as "2/3"; tables that were there are removed.
  void publish_shard(const Study& study, const std::string& shard, std::size_t num_teams, const RunFacts& facts);

 private:
  void check_content(bool replace);
  void write_inputs(const std::filesystem::path& folder) const;
  void commit(Generation& generation, const std::string& manifest, const RunFacts& facts,
              const std::vector<std::string>& removed);

  std::filesystem::path path_;
  RunInputs inputs_;
  std::optional<FolderLock> lock_;
  bool made_ = false;   // the folder
  bool froze_ = false;  // the inputs
  bool has_results_ = false;
  bool published_ = false;
};

/// The name of the journal in a run folder.
inline constexpr const char* kJournalFile = "study.sqlite";

/// The digest of the inputs that the results in the folder are of (RunInputs::digest()), as its manifest says; nothing
/// if there is none, or if it is not as it was written.
[[nodiscard]] std::optional<std::string> published_digest(const std::filesystem::path& folder);

/// What the manifest in the folder says under `key`, such as "domain", if that is a text and the manifest is as it was
/// written.
[[nodiscard]] std::optional<std::string> published_fact(const std::filesystem::path& folder, const std::string& key);

/// The study of a run, from its frozen inputs, which must be those that its manifest, or its journal if the run is not
/// finished, is about.
/// @throws kith::Error kIo if the folder is no run folder, kMismatch if the inputs are not those of the run.
[[nodiscard]] StudyReading read_run_folder(const std::filesystem::path& path, const StudyKinds& kinds = {});

}  // namespace kith
