#pragma once

#include <cstddef>
#include <functional>

namespace kith {

struct ParallelOptions {
  std::size_t threads = 0;  ///< 0: as many as there are cores. Changes the speed, never a result.
  /// Called now and then, from any thread, one call at a time. Returning false ends the loop after the tasks under way.
  std::function<bool(std::size_t done, std::size_t total)> on_progress;
};

/// Calls body(i) once for every i in [0, n), on several threads and in no particular order. A task writes to its own
/// place only, so results depend on i alone.
/// @return whether all were called: false if on_progress said stop.
/// The first exception of a task ends the loop and is thrown again.
bool for_each_index(std::size_t n, const ParallelOptions& options, const std::function<void(std::size_t i)>& body);

}  // namespace kith
