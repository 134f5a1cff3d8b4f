#include "journal_writer.hpp"

#include <utility>

namespace kith {
namespace {

constexpr std::size_t kManyBytes = std::size_t{8} << 20;  // a batch of this size does not wait
constexpr std::size_t kTooMany = std::size_t{32} << 20;   // more are not kept in memory: teaching waits for the disk

}  // namespace

void JournalWriter::add(JournalEntry entry) {
  {
    const std::lock_guard lock{pending_mutex_};
    pending_.bytes += entry.bytes.size();
    pending_.entries.push_back(std::move(entry));
  }
  save_if_due();
}

void JournalWriter::fail(TeamFailure failure) {
  {
    const std::lock_guard lock{pending_mutex_};
    pending_.failures.push_back(std::move(failure));
  }
  save_if_due();
}

void JournalWriter::save_if_due() {
  std::unique_lock saving{journal_mutex_, std::defer_lock};
  Batch batch;
  {
    std::unique_lock lock{pending_mutex_};
    const bool due = pending_.bytes > kManyBytes || Clock::now() - last_ >= interval_;
    if (!due) return;
    if (pending_.bytes > kTooMany) {
      lock.unlock();
      saving.lock();
      lock.lock();
    } else if (!saving.try_lock()) {
      return;  // another thread is saving; this team is in the next batch
    }
    batch = std::exchange(pending_, {});
  }
  save(batch);
  const std::lock_guard lock{pending_mutex_};
  last_ = Clock::now();
}

void JournalWriter::flush() {
  const std::lock_guard saving{journal_mutex_};
  if (!broken_) save(std::exchange(pending_, {}));
}

void JournalWriter::save(const Batch& batch) {
  if (batch.entries.empty() && batch.failures.empty()) return;
  broken_ = true;  // until we know better
  journal_.write(batch.entries, batch.failures);
  broken_ = false;
}

}  // namespace kith
