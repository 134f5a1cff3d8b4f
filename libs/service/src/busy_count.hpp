#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace kith {

// Counts what is under way on any thread, so that somebody can wait until nothing is.
class BusyCount {
 public:
  void begin() {
    const std::lock_guard lock{mutex_};
    ++count_;
  }
  void end() {
    {
      const std::lock_guard lock{mutex_};
      --count_;
    }
    changed_.notify_all();
  }
  // Counts a job from now until it has been called and what it holds is gone: that may need what is destroyed after us.
  template <typename... Arguments>
  [[nodiscard]] auto during(std::function<void(Arguments...)> job) {
    begin();
    return [this, job = std::move(job)](Arguments... arguments) mutable {
      job(arguments...);
      job = nullptr;
      end();
    };
  }
  void wait_for_none() {
    std::unique_lock lock{mutex_};
    changed_.wait(lock, [&] { return count_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t count_ = 0;
};

}  // namespace kith
