#pragma once

#include <cstddef>
#include <string>

namespace kith::cli {

/// "Intel(R) Xeon(R) ...", or "unknown".
[[nodiscard]] std::string processor_name();

/// Processors that this process may use, at least 1.
[[nodiscard]] std::size_t usable_cores();

/// Processes that wanted to run, on average over the last minute; 0 where the system does not say.
[[nodiscard]] double load_average();

/// The most memory this process has had, in MiB.
[[nodiscard]] double peak_memory_mib();

}  // namespace kith::cli
