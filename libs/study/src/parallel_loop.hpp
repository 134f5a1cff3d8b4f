#pragma once

#include <cstddef>
#include <functional>

namespace kith {

// Calls body(worker, i) for every i in [0, n), on the calling thread and up to num_workers - 1 others, each
// i once, in no particular order. `worker` is in [0, num_workers) and never
// handed to two calls at a time, so that it can index scratch memory. The first exception ends
// the loop and is rethrown.
//
// Where the system gives fewer threads (a limit on processes or memory), the loop goes on with those that there are,
// down to the calling one alone.
void parallel_loop(std::size_t n, std::size_t num_workers,
                   const std::function<void(std::size_t worker, std::size_t i)>& body);

// As many as there are cores that this process may use, at least 1.
[[nodiscard]] std::size_t default_num_workers();

}  // namespace kith
