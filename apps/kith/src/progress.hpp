#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include "console.hpp"

namespace kith::cli {

/// Shows how far a run is, on standard error: a bar with the time left on a terminal,
/// else a line every 10 seconds; or one JSON object a second. Where it cannot be written (the terminal was closed, the
/// disk is full) the work goes on without it.
class Progress {
 public:
  /// @param noun  what is counted, in the plural.
  Progress(ProgressMode mode, const Console& console, std::string noun = "teams");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// From here on time counts, with so many done already.
  void begin(std::size_t done);
  void update(std::size_t done, std::size_t total, std::size_t failed = 0);
  /// For loops that report how far they are and go on while this is true: update(), until a signal asks to stop.
  [[nodiscard]] std::function<bool(std::size_t done, std::size_t total)> until_stopped();
  /// Removes the bar.
  void finish() noexcept;

 private:
  using Clock = std::chrono::steady_clock;

  ProgressMode mode_;
  std::string noun_;
  bool lines_ = false;  // neither bar nor JSON: a line now and then
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  std::size_t before_ = 0;  // done when it began
  bool drawn_ = false;
  bool has_line_ = false;  // of a number below all
};

/// "1:05" or "2:03:04"; for people who wait.
[[nodiscard]] std::string clock_text(double seconds);

}  // namespace kith::cli
