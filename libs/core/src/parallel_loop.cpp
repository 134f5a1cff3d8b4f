#include "kith/core/parallel_loop.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace kith {
namespace {

// What the threads of a loop share.
class Loop {
 public:
  Loop(std::size_t n, const std::function<void(std::size_t worker, std::size_t i)>& body) : n_{n}, body_{body} {}

  [[nodiscard]] bool has_work() const { return next_ < n_; }

  void work(std::size_t worker) noexcept {
    try {
      for (auto i = next_++; i < n_; i = next_++) body_(worker, i);
    } catch (...) {
      next_ = n_;  // nobody begins another
      const std::lock_guard lock{failing_};
      if (!failure_) failure_ = std::current_exception();
    }
  }

  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::size_t n_;
  const std::function<void(std::size_t worker, std::size_t i)>& body_;
  std::atomic<std::size_t> next_{0};
  std::mutex failing_;
  std::exception_ptr failure_;
};

}  // namespace

std::size_t default_num_workers() {
  cpu_set_t mine;
  CPU_ZERO(&mine);
  const bool known = sched_getaffinity(0, sizeof mine, &mine) == 0;
  const auto count = known ? static_cast<unsigned>(CPU_COUNT(&mine)) : std::thread::hardware_concurrency();
  return std::max<std::size_t>(1, count);
}

void parallel_loop(std::size_t n, std::size_t num_workers,
                   const std::function<void(std::size_t worker, std::size_t i)>& body) {
  Loop loop{n, body};
  {
    const auto most = std::min(num_workers, n);
    std::vector<std::jthread> others;
    others.reserve(most);
    try {
      while (others.size() + 1 < most && loop.has_work()) {
        others.emplace_back([&loop, worker = others.size() + 1] { loop.work(worker); });
      }
    } catch (const std::system_error&) {  // no thread to be had: what there is does the work
    }
    loop.work(0);
  }
  loop.rethrow_failure();
}

}  // namespace kith
