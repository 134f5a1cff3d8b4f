#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "busy_count.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {

// Jobs that touch the same room, one at a time and in the order in which they came; jobs of different rooms at the same
// time. Each thread has a cache of its own, which jobs may use.
class Strands {
 public:
  using Job = std::function<void(TeachingCache& cache)>;

  Strands(const std::shared_ptr<const Atlas>& atlas, std::size_t threads, std::size_t cache_bytes, BusyCount& busy);
  // Does what has been posted.
  ~Strands();
  Strands(const Strands&) = delete;
  Strands& operator=(const Strands&) = delete;

  // From any thread, jobs included. Jobs must not throw.
  void post(std::size_t key, Job job);

 private:
  struct Queue {
    std::deque<Job> jobs;
    bool is_running = false;
  };
  void run(std::shared_ptr<const Atlas> atlas, std::size_t cache_bytes, std::shared_ptr<PartitionStore> store);

  BusyCount& busy_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unordered_map<std::size_t, Queue> queues_;
  std::deque<std::size_t> ready_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace kith
