#pragma once

#include <cstddef>
#include <functional>

namespace kith {

// Calls body(worker, i) for every i in [0, n), on up to num_workers threads, each
// i once, in no particular order. `worker` is in [0, num_workers) and never
// handed to two calls at a time, so that it can index scratch memory. The first exception ends
// the loop and is rethrown.
//
// The only place that knows oneTBB. ThreadSanitizer does not see the
// synchronisation inside that library, so this file is compiled without it and tells it
// what oneTBB guarantees: all before the loop happens before every call, every
// call before all after the loop, and the calls of one worker one after the other.
void parallel_loop(std::size_t n, std::size_t num_workers,
                   const std::function<void(std::size_t worker, std::size_t i)>& body);

// As many as the machine has cores.
[[nodiscard]] std::size_t default_num_workers();

}  // namespace kith
