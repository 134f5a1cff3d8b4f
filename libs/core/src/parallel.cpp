#include "kith/core/parallel.hpp"

#include <atomic>
#include <mutex>

#include "kith/core/parallel_loop.hpp"

namespace kith {

bool for_each_index(std::size_t n, const ParallelOptions& options, const std::function<void(std::size_t i)>& body) {
  std::atomic<bool> stopped{false};
  std::atomic<std::size_t> called{0};
  std::size_t done = 0;
  std::mutex progress;
  const auto num_workers = options.threads == 0 ? default_num_workers() : options.threads;
  parallel_loop(n, num_workers, [&](std::size_t, std::size_t i) {
    if (stopped) return;
    body(i);
    ++called;
    if (!options.on_progress) return;
    const std::lock_guard lock{progress};
    if (!options.on_progress(++done, n)) stopped = true;
  });
  return called == n;
}

}  // namespace kith
