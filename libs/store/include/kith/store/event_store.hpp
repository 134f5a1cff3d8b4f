#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "kith/files/folder_lock.hpp"
#include "kith/store/event_file.hpp"

namespace kith {

/// What an EventStore has done so far.
struct StoreCounters {
  std::uint64_t events = 0;    ///< On the disk.
  std::size_t waiting = 0;     ///< Batches handed in of which it is not known yet whether they are saved.
  std::uint64_t commits = 0;   ///< Transactions.
  std::uint64_t failures = 0;  ///< Batches that could not be saved.
  std::int64_t last_commit_us = 0;
  std::string problem{};  ///< Why the last batch could not be saved; empty if it was.
};

/// The store of a server: one thread writes what many hand in. Whatever has come in while the last transaction went to
/// the disk is one transaction (group commit). The folder is locked while the object lives.
class EventStore {
 public:
  /// Called when a batch is on the disk or could not be saved; then nothing of it is stored, and it can be handed in
  /// again. Called by the thread that writes; must not block.
  using Done = std::function<void(bool saved)>;

  /// @param now_us  the clock; called by the thread that writes.
  /// @throws kith::Error kBusy E1610 (another process serves the folder); as EventFile::open().
  EventStore(const std::filesystem::path& folder, const StoreIdentity& identity, std::function<std::int64_t()> now_us);
  /// Saves what is waiting.
  ~EventStore();
  EventStore(const EventStore&) = delete;
  EventStore& operator=(const EventStore&) = delete;

  /// The file, to read what was saved before the first write().
  [[nodiscard]] EventFile& file() noexcept { return file_; }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Hands in a batch. Batches are saved in the order in which they come. From any thread.
  void write(StoreBatch batch, Done done);
  /// Waits until nothing is waiting, and what waited is let go.
  void flush();
  [[nodiscard]] StoreCounters counters() const;

 private:
  struct Waiting {
    StoreBatch batch;
    Done done;
  };

  void run();
  [[nodiscard]] bool save(std::vector<StoreBatch>& batches);
  void finish(std::vector<Waiting>& group);

  std::filesystem::path folder_;
  std::function<std::int64_t()> now_us_;
  FolderLock lock_;
  EventFile file_;
  bool broken_ = false;  // the connection has to be opened again

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  StoreCounters counters_;
  std::size_t unfinished_ = 0;  // batches whose Done has not returned yet
  bool stopping_ = false;
  std::thread writer_;
};

}  // namespace kith
