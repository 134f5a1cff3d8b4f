#pragma once

#include <string>

#include "console.hpp"

namespace kith::cli {

/// From now on a reader that went away, or a file that may not grow, is an error of write(), not the end.
void ignore_broken_pipes();

/// From now on SIGINT, SIGTERM and SIGHUP set a flag, and the command comes to an orderly end of its own. One that has
/// not done so 0.8 seconds later, because a single step takes long, is ended with exit code 128 + signal: whatever kith
/// writes is replaced as a whole or can be resumed, so nothing is lost but unsaved work. A second signal ends the
/// program at once. SIGHUP stays ignored where it was, as under nohup.
void watch_signals();

/// From now on a signal is the normal way to end, as for a server: the command has 3 seconds, and the exit code is 0
/// even if it is ended then. @pre whatever it has acknowledged is saved.
void expect_to_be_stopped() noexcept;

/// The signal that asked us to stop, or 0.
[[nodiscard]] int stop_signal() noexcept;

/// Says what an interrupted command leaves behind, also as JSON. @param command  resumes it; empty: nothing does.
/// @return the exit code.
int interrupted(const std::string& what, Console& console, const std::string& command = {});

}  // namespace kith::cli
