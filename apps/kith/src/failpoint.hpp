#pragma once

#include <functional>
#include <string>

namespace kith::cli {

/// For tests of what survives: with KITH_FAILPOINT=INSTANT:N in the environment the program kills itself (SIGKILL) when
/// it comes to that instant for the N-th time, see StudyRunOptions::on_instant; INSTANT:N:MICROSECONDS does so a little
/// later. Without it, an empty function.
[[nodiscard]] std::function<void(const std::string& instant)> failpoint();

}  // namespace kith::cli
