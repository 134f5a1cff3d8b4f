#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kith::faults {

using Words = std::vector<std::string>;
using Environment = std::vector<std::pair<std::string, std::string>>;

/// The exit code of what SIGKILL ended.
inline constexpr int kKilled = 128 + 9;

/// What to start, and how.
struct Command {
  Words words;                     ///< The program's path and its arguments.
  Environment environment{};       ///< In addition to ours without KITH_*.
  std::filesystem::path folder{};  ///< The current folder; what it prints goes to `out` and `err` beside it.
  std::optional<std::chrono::microseconds> kill_after{};  ///< Kill it then, if it still runs.
};

/// What it came to.
struct Ended {
  int code = -1;      ///< Exit code; 128 + signal if one ended it.
  bool hung = false;  ///< It took longer than a minute and was killed.
  std::string out{}, err{};
};

/// Runs a command to its end. @throws kith::Error if it cannot be started.
[[nodiscard]] Ended run(const Command& command);

}  // namespace kith::faults
