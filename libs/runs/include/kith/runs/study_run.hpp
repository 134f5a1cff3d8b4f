#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/ranks.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study.hpp"
#include "kith/study/summary.hpp"

namespace kith {

/// What to do with teams that the folder's journal already holds.
enum class Resume {
  kAuto,     ///< Go on where there is something to go on with, else begin.
  kNever,    ///< Begin anew.
  kRequire,  ///< Go on, or fail.
};

struct StudyRunOptions {
  std::string program;      ///< Version and commit of the program, see JournalIdentity.
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never a result.
  Resume resume = Resume::kAuto;
  bool replace = false;  ///< Whether the folder may hold something else, which is then replaced.
  /// Whether a journal of which nothing can be read is begun anew: for those who have the teams from elsewhere.
  bool rebuild = false;
  Shard shard;                           ///< The part of the study that is run here.
  bool keep_going = false;               ///< Whether a team that fails stops the run.
  double checkpoint_seconds = 0.2;       ///< A finished team waits no longer for being saved, while others go on.
  std::optional<std::uint64_t> shuffle;  ///< Teach in a random order, from this seed.
  Ranks* ranks = nullptr;                ///< The processes that share the work; null: this one alone.
  /// Called after every team, one call at a time.
  std::function<void(std::size_t done, std::size_t total, std::size_t failed)> on_progress;
  std::function<bool()> stopped;  ///< Asked often, from any thread; once true, what is finished is saved.
};

/// One run of a study into a folder, from opening it to publishing tables. What is finished is saved in the folder's
/// journal all the time, so whatever ends the run, the next one with the same inputs and program goes on from there,
/// and the tables have the same bytes as if nothing had happened; likewise for any number of threads, ranks and shards.
///
/// All errors are kith::Error. With ranks, every rank makes the object, teaches and publishes; the others of
/// them than rank 0 write to a journal of their own, which rank 0 (or the next run) takes up.
class StudyRun {
 public:
  /// Opens the folder and its journal. @pre the reading has a study, the shard is one.
  /// @throws kith::Error as RunFolder does; kIo if the journal is damaged beyond help; kUsage if it holds unfinished
  /// work of another program or shard (unless `replace`), or if there is nothing to resume and there must be.
  StudyRun(std::filesystem::path folder, StudyReading reading, StudyRunOptions options);
  ~StudyRun();
  StudyRun(const StudyRun&) = delete;
  StudyRun& operator=(const StudyRun&) = delete;

  [[nodiscard]] const Study& study() const;
  /// Teams of this shard, and those of them that were in the journal already.
  [[nodiscard]] std::size_t num_teams() const;
  [[nodiscard]] std::size_t num_resumed() const;
  [[nodiscard]] std::size_t num_done() const;
  /// What people should know about the journal: damaged records, and the like.
  [[nodiscard]] const std::vector<std::string>& notes() const;
  /// The teams that failed in this run, in order.
  [[nodiscard]] const std::vector<TeamFailure>& failures() const;

  /// Teaches the teams that are missing. @return whether all were tried: false if it was stopped.
  /// @throws kith::Error if the journal cannot be written; without keep_going whatever a team threw, its address in
  /// front. What was finished before is saved.
  bool teach(const Atlas& atlas);

  /// Saves the teams that another journal of the same study holds, of a shard for instance, with its failures, instead
  /// of teaching them.
  void take_up(const Journal& journal);

  /// Writes the tables from the journal, and sums them up. On ranks other than 0 nothing happens.
  /// @pre teach() returned true, or all teams were taken up; the shard is the whole study.
  /// @throws kith::Error (kMismatch) if a team is missing that did not fail, unless facts.missing says that some are.
  std::optional<StudySummary> publish(RunFacts facts);

  /// For a shard, which has no tables of its own: leaves the journal as one file, and the inputs beside it with a
  /// manifest that says which shard it is. @pre teach() returned true.
  void publish_shard(RunFacts facts);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Hands every team of the journal to what it is given, in order. The arguments must outlive the result.
[[nodiscard]] TeamSource teams_of(const Study& study, const Journal& journal);

}  // namespace kith
