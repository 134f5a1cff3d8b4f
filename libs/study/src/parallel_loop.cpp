#include "parallel_loop.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <vector>

#ifdef KITH_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace kith {
namespace {

#ifdef KITH_THREAD_SANITIZER
void acquire(void* address) { __tsan_acquire(address); }
void release(void* address) { __tsan_release(address); }
#else
void acquire(void*) {}
void release(void*) {}
#endif

}  // namespace

std::size_t default_num_workers() { return static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()); }

void parallel_loop(std::size_t n, std::size_t num_workers,
                   const std::function<void(std::size_t worker, std::size_t i)>& body) {
  const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, num_workers};
  tbb::task_arena arena{static_cast<int>(num_workers)};
  char begin = 0;
  char end = 0;
  std::vector<char> workers(num_workers);
  release(&begin);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>{0, n, 1}, [&](const tbb::blocked_range<std::size_t>& range) {
      const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
      acquire(&begin);
      acquire(&workers[worker]);
      for (auto i = range.begin(); i != range.end(); ++i) body(worker, i);
      release(&workers[worker]);
      release(&end);
    });
  });
  acquire(&end);
}

}  // namespace kith
