#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kith {

/// As many threads as the system grants, at most `wanted`; each runs `body`. May be none.
[[nodiscard]] std::vector<std::jthread> start_threads(std::size_t wanted, const std::function<void()>& body);

/// Threads that do jobs in the order in which they came.
class WorkerPool {
 public:
  WorkerPool(std::size_t wanted, std::size_t max_waiting);
  ~WorkerPool() { stop(); }
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Does the job on a thread of the pool, or right here if the system granted none. @return false if too many wait.
  [[nodiscard]] bool post(std::function<void()> job);
  /// Finishes the jobs that run and drops those that wait.
  void stop();
  [[nodiscard]] std::size_t num_threads() const { return threads_.size(); }

 private:
  void work();

  std::size_t max_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopped_ = false;
  std::deque<std::function<void()>> jobs_;
  std::vector<std::jthread> threads_;
};

}  // namespace kith
