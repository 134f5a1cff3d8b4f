#pragma once

#include <cstddef>
#include <functional>

namespace kith {

/// Calls body(worker, i) once for every i in [0, n), on the calling thread and up to num_workers - 1 others, in no
/// particular order. `worker` is in [0, num_workers) and never passed to two calls at a time, so it can index scratch
/// memory. The first exception ends the loop and is rethrown.
///
/// If the system grants fewer threads (limits on processes or memory), the loop continues with those it has, at least
/// the calling one.
void parallel_loop(std::size_t n, std::size_t num_workers,
                   const std::function<void(std::size_t worker, std::size_t i)>& body);

/// The number of cores that this process may use, at least 1.
[[nodiscard]] std::size_t default_num_workers();

}  // namespace kith
