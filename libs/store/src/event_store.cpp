#include "kith/store/event_store.hpp"

#include <exception>
#include <iterator>
#include <system_error>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

FolderLock lock_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error{ErrorKind::kIo, "cannot make " + folder.string() + ": " + error.message()};
  auto lock = FolderLock::try_acquire(folder);
  if (!lock) {
    refuse_run(ErrorKind::kBusy, "E1610", folder, "another process serves the sessions in this folder",
               "stop it, or use another folder");
  }
  return std::move(*lock);
}

}  // namespace

EventStore::EventStore(const fs::path& folder, const StoreIdentity& identity, std::function<std::int64_t()> now_us)
    : folder_{folder},
      now_us_{std::move(now_us)},
      lock_{lock_folder(folder)},
      file_{EventFile::open(folder, identity, now_us_())} {
  counters_.events = file_.count_events();
  writer_ = std::thread{[this] { run(); }};
}

EventStore::~EventStore() {
  {
    const std::lock_guard lock{mutex_};
    stopping_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

void EventStore::write(StoreBatch batch, Done done) {
  {
    const std::lock_guard lock{mutex_};
    waiting_.push_back({std::move(batch), std::move(done)});
    ++counters_.waiting;
    ++unfinished_;
  }
  changed_.notify_all();
}

void EventStore::flush() {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [&] { return unfinished_ == 0; });
}

StoreCounters EventStore::counters() const {
  const std::lock_guard lock{mutex_};
  return counters_;
}

void EventStore::run() {
  while (true) {
    std::vector<Waiting> group;
    {
      std::unique_lock lock{mutex_};
      changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      group = std::exchange(waiting_, {});
    }
    finish(group);
    const auto finished = group.size();
    group.clear();
    {
      const std::lock_guard lock{mutex_};
      unfinished_ -= finished;
    }
    changed_.notify_all();
  }
}

// Saves all of them in one transaction or, if that fails, each on its own: one that cannot be saved must not take the
// others with it.
void EventStore::finish(std::vector<Waiting>& group) {
  std::vector<StoreBatch> batches;
  batches.reserve(group.size());
  for (auto& waiting : group) batches.push_back(std::move(waiting.batch));
  if (save(batches)) {
    for (auto& waiting : group) waiting.done(true);
    return;
  }
  for (std::size_t i = 0; i < group.size(); ++i) {
    std::vector<StoreBatch> alone;
    alone.push_back(std::move(batches[i]));
    const bool saved = group.size() > 1 && save(alone);
    if (!saved) {
      const std::lock_guard lock{mutex_};
      ++counters_.failures;
      --counters_.waiting;
    }
    group[i].done(saved);
  }
}

bool EventStore::save(std::vector<StoreBatch>& batches) {
  std::uint64_t events = 0;
  for (const auto& batch : batches) events += batch.events.size();
  std::string problem;
  try {
    if (std::exchange(broken_, true)) file_.reopen();
    file_.write(batches);
    broken_ = false;
  } catch (const std::exception& error) {
    problem = error.what();
  }
  const std::lock_guard lock{mutex_};
  counters_.problem = problem;
  if (!problem.empty()) return false;
  counters_.events += events;
  counters_.waiting -= batches.size();
  ++counters_.commits;
  counters_.last_commit_us = now_us_();
  return true;
}

}  // namespace kith
