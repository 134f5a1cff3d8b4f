#pragma once

namespace kith::cli {

/// From now on a reader that went away, or a file that may not grow, is an error of write(), not the end.
void ignore_broken_pipes();

/// From now on SIGINT, SIGTERM and SIGHUP only set a flag; a second one ends the program at once.
void watch_signals();

/// The signal that asked us to stop, or 0.
[[nodiscard]] int stop_signal() noexcept;

}  // namespace kith::cli
