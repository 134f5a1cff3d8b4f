#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "busy_count.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {

// Threads that choose lessons. What a room waits for comes first, what it will probably need comes when nothing else is
// to be done.
class TeachingPool {
 public:
  using Job = std::function<void(TeachingCache& cache)>;
  enum class Urgency { kNow, kAhead };

  TeachingPool(const std::shared_ptr<const Atlas>& atlas, std::size_t threads, std::size_t cache_bytes,
               BusyCount& busy);
  ~TeachingPool() { stop(); }
  TeachingPool(const TeachingPool&) = delete;
  TeachingPool& operator=(const TeachingPool&) = delete;

  // Finishes the jobs under way and forgets the others, and those that come later. May be called twice.
  void stop();
  // From any thread. Jobs must not throw. A job that is only ahead of time is forgotten if too many are waiting.
  void post(Urgency urgency, Job job);

 private:
  void run(std::shared_ptr<const Atlas> atlas, std::size_t cache_bytes, std::shared_ptr<PartitionStore> store);

  BusyCount& busy_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> now_;
  std::deque<Job> ahead_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace kith
