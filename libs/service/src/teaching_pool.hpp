#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "busy_count.hpp"
#include "kith/teaching/cache.hpp"
#include "threads.hpp"

namespace kith {

// Caches for jobs that need one for a moment: as many as there are at a time. Thread-safe.
class TeachingCaches {
 public:
  TeachingCaches(std::shared_ptr<const Atlas> atlas, std::size_t bytes)
      : atlas_{std::move(atlas)}, bytes_{bytes}, store_{std::make_shared<PartitionStore>(*atlas_)} {}

  template <typename Use>
  void lend(const Use& use) {
    auto cache = take();
    use(*cache);
    const std::lock_guard lock{mutex_};
    idle_.push_back(std::move(cache));
  }

 private:
  [[nodiscard]] std::unique_ptr<TeachingCache> take() {
    const std::lock_guard lock{mutex_};
    if (idle_.empty()) return std::make_unique<TeachingCache>(atlas_, bytes_, store_);
    auto cache = std::move(idle_.back());
    idle_.pop_back();
    return cache;
  }

  std::shared_ptr<const Atlas> atlas_;
  std::size_t bytes_;
  std::shared_ptr<PartitionStore> store_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TeachingCache>> idle_;
};

// Threads that choose lessons. What a room waits for comes first, what it will probably need comes when nothing else is
// to be done.
class TeachingPool {
 public:
  using Job = std::function<void(TeachingCache& cache)>;
  enum class Urgency { kNow, kAhead };

  // @param cache_bytes  what each of the threads remembers, see TeachingCache.
  TeachingPool(std::shared_ptr<const Atlas> atlas, std::size_t threads, std::size_t cache_bytes, BusyCount& busy)
      : busy_{busy}, caches_{std::move(atlas), cache_bytes}, threads_{threads} {}
  ~TeachingPool() { stop(); }
  TeachingPool(const TeachingPool&) = delete;
  TeachingPool& operator=(const TeachingPool&) = delete;

  // Finishes the jobs under way and forgets the others, and those that come later. May be called twice.
  void stop();
  // From any thread. Jobs must not throw. A job that is only ahead of time is forgotten if too many are waiting.
  void post(Urgency urgency, Job job);

 private:
  void do_next();

  BusyCount& busy_;
  TeachingCaches caches_;
  std::mutex mutex_;
  std::deque<Job> now_;
  std::deque<Job> ahead_;
  bool is_stopping_ = false;
  Threads threads_;
};

}  // namespace kith
