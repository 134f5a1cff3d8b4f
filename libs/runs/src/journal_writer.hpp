#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "kith/runs/journal.hpp"

namespace kith {

// Collects finished teams from several threads and saves them in batches: a thread that brings a team when the last
// batch is old enough saves what has come in since, while the others go on teaching.
class JournalWriter {
 public:
  JournalWriter(Journal& journal, double seconds) : journal_{journal}, interval_{seconds} {}

  // From any thread. They throw if a batch cannot be saved.
  void add(JournalEntry entry);
  void fail(TeamFailure failure);
  // Saves all. Not while others add.
  void flush();

 private:
  using Clock = std::chrono::steady_clock;
  struct Batch {
    std::vector<JournalEntry> entries;
    std::vector<TeamFailure> failures;
    std::size_t bytes = 0;
  };

  void save_if_due();
  void save(const Batch& batch);

  Journal& journal_;
  std::chrono::duration<double> interval_;
  std::mutex pending_mutex_;
  Batch pending_;
  Clock::time_point last_ = Clock::now();
  std::mutex journal_mutex_;
  bool broken_ = false;
};

}  // namespace kith
