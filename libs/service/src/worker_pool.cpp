#include "worker_pool.hpp"

#include <system_error>
#include <utility>

namespace kith {

std::vector<std::jthread> start_threads(std::size_t wanted, const std::function<void()>& body) {
  std::vector<std::jthread> threads;
  threads.reserve(wanted);
  try {
    while (threads.size() < wanted) threads.emplace_back(body);
  } catch (const std::system_error&) {  // a limit on processes or memory: those that there are do the work
  }
  return threads;
}

WorkerPool::WorkerPool(std::size_t wanted, std::size_t max_waiting) : max_waiting_{max_waiting} {
  threads_ = start_threads(wanted, [this] { work(); });
}

bool WorkerPool::post(std::function<void()> job) {
  {
    const std::lock_guard lock{mutex_};
    if (is_stopped_ || jobs_.size() >= max_waiting_) return false;
    if (!threads_.empty()) {
      jobs_.push_back(std::move(job));
      changed_.notify_one();
      return true;
    }
  }
  job();
  return true;
}

void WorkerPool::stop() {
  std::deque<std::function<void()>> dropped;  // destroyed without the lock: a job may hold a connection
  {
    const std::lock_guard lock{mutex_};
    is_stopped_ = true;
    dropped.swap(jobs_);
  }
  changed_.notify_all();
  for (auto& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void WorkerPool::work() {
  for (;;) {
    std::function<void()> job;
    {
      std::unique_lock lock{mutex_};
      changed_.wait(lock, [this] { return is_stopped_ || !jobs_.empty(); });
      if (is_stopped_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job();
  }
}

}  // namespace kith
