#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/runs/run_folder.hpp"

namespace kith {

/// Part `index` of `count` of a study: the teams whose number leaves the same remainder.
struct Shard {
  std::size_t index = 1;  ///< 1 to count.
  std::size_t count = 1;
  [[nodiscard]] bool contains(std::size_t team) const noexcept { return (team - 1) % count == index - 1; }
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// Whose work a journal holds. Work is put together only where all of it is equal.
struct JournalIdentity {
  RunInputs inputs;
  std::string program;    ///< Version and commit: another program may give other bytes.
  std::size_t teams = 0;  ///< Of the whole study, at most kMaxTeams.
  Shard shard;
  friend bool operator==(const JournalIdentity&, const JournalIdentity&) = default;

  /// What the records of its teams are sealed with (team_codec.hpp): 32 bytes that tell the inputs and the program. All
  /// shards have the same.
  [[nodiscard]] std::string key() const;
};

/// A finished team on its way into a journal.
struct JournalEntry {
  std::size_t team = 0;  ///< Its number, from 1.
  std::string bytes;     ///< encode_team()
};

/// A team that could not be taught.
struct TeamFailure {
  std::size_t team = 0;
  std::string message;
  friend bool operator==(const TeamFailure&, const TeamFailure&) = default;
};

/// How far a journal is, for those who wait.
struct JournalProgress {
  std::size_t total = 0;  ///< Teams of the study, or of the shard.
  std::size_t done = 0;
  std::vector<TeamFailure> failures;
  double started = 0.0;           ///< When the last session began and wrote for the last time, in seconds
  double last_write = 0.0;        ///< since 1970; 0 if never.
  std::size_t session_teams = 0;  ///< Teams finished in that session.
};

/// The file in a run folder that finished teams are saved in while a study runs (`study.sqlite`): an SQLite database
/// in WAL mode. What write() has been given is there after a crash of the program at any instant, and of the machine
/// too; what was not given yet is missing as a whole. Every team has a checksum of its own, which also tells whose work
/// it is.
///
/// All errors are kith::Error (kIo) with the path. Not thread-safe.
class Journal {
 public:
  /// A new one, in place of what was there.
  [[nodiscard]] static Journal create(const std::filesystem::path& path, const JournalIdentity& identity);

  /// One that exists, to go on writing. All teams are checked: the numbers of those that are there but damaged are in
  /// damaged(), and are not among the teams that are done. If the file itself is damaged, or a file beside it belongs
  /// to another journal, every intact record of this identity is copied to a new file, and the old one is kept as
  /// `PATH.damaged`; this can be ended at any time and is then repeated.
  /// @return nothing, and nothing is changed, if the file is damaged and holds no record of this identity.
  /// @throws kith::Error (kUsage) if it is the journal of another identity.
  [[nodiscard]] static std::optional<Journal> open(const std::filesystem::path& path, const JournalIdentity& identity);

  /// One that exists, to look at, even while another process writes to it. Nothing is changed.
  [[nodiscard]] static Journal read(const std::filesystem::path& path);

  /// Whose journal it is; nothing if it cannot be told, or if there is none.
  /// @throws kith::Error kUsage if it is of another version of kith.
  [[nodiscard]] static std::optional<JournalIdentity> identify(const std::filesystem::path& path);

  /// Whether there is one, sound or not.
  [[nodiscard]] static bool exists(const std::filesystem::path& path);

  /// Removes it and the files beside it, but not `PATH.damaged`.
  static void remove(const std::filesystem::path& path);

  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] const JournalIdentity& identity() const;
  /// See JournalIdentity::key().
  [[nodiscard]] const std::string& key() const;
  /// Whether the team with number i + 1 is there and intact, at i. For one that was opened to be read, after check().
  [[nodiscard]] const std::vector<bool>& done() const;
  [[nodiscard]] std::size_t num_done() const;
  [[nodiscard]] const std::vector<std::size_t>& damaged() const;
  /// Whether open() had to make a new file.
  [[nodiscard]] bool was_recovered() const;

  /// Finds out which teams are there and intact, as open() does. @return whether the file is sound.
  [[nodiscard]] bool check();

  /// Marks the beginning of a session, for progress().
  void begin_session();
  /// Saves all of it or, if it fails, nothing. A team that is saved is no failure any more.
  void write(std::span<const JournalEntry> entries, std::span<const TeamFailure> failures = {});
  /// Saves what another journal of the same study holds and this one does not; damaged teams are left out.
  void absorb(const Journal& other);
  /// Puts all of it into the one file, so that it can be copied, and read where nothing can be written.
  void close();

  /// Teams in ascending order with their bytes, which are checked. @throws kith::Error (kIo) for a damaged one.
  void for_each(const std::function<void(std::size_t team, std::string_view bytes)>& visit) const;
  /// The bytes of a team, as they are; nothing if it is not there.
  [[nodiscard]] std::optional<std::string> find(std::size_t team) const;
  [[nodiscard]] JournalProgress progress() const;

 private:
  struct State;
  explicit Journal(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// How the names of journals of other ranks than 0 begin.
inline constexpr const char* kRankJournalPrefix = "study.rank-";
/// Those that are in a folder: of ranks that are at work, or that were ended before they were taken up.
[[nodiscard]] std::vector<std::filesystem::path> rank_journals(const std::filesystem::path& folder);

/// The version of SQLite.
[[nodiscard]] std::string journal_library_version();

}  // namespace kith
