#include "progress.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "interrupt.hpp"

namespace kith::cli {
namespace {

std::size_t terminal_width() {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

}  // namespace

std::string clock_text(double seconds) {
  const auto all = static_cast<long>(std::ceil(seconds));
  if (all < 3600) return fmt::format("{}:{:02}", all / 60, all % 60);
  return fmt::format("{}:{:02}:{:02}", all / 3600, all / 60 % 60, all % 60);
}

Progress::Progress(ProgressMode mode, const Console& console, std::string noun) : mode_{mode}, noun_{std::move(noun)} {
  if (mode_ == ProgressMode::kAuto) {
    mode_ = console.log_is_terminal() ? ProgressMode::kBar : ProgressMode::kNone;
    lines_ = !console.log_is_terminal();
    if (console.quiet()) {
      mode_ = ProgressMode::kNone;
      lines_ = false;
    }
  }
}

Progress::~Progress() { finish(); }

void Progress::begin(std::size_t done) {
  start_ = Clock::now();
  last_ = start_;
  before_ = done;
}

void Progress::update(std::size_t done, std::size_t total, std::size_t failed) {
  if (mode_ == ProgressMode::kNone && !lines_) return;
  const auto now = Clock::now();
  const auto interval = mode_ == ProgressMode::kBar    ? std::chrono::milliseconds{100}
                        : mode_ == ProgressMode::kJson ? std::chrono::milliseconds{1000}
                                                       : std::chrono::milliseconds{10'000};
  const bool last = done == total && (mode_ == ProgressMode::kJson || (lines_ && has_line_));
  if (now - last_ < interval && !last) return;
  last_ = now;
  const double elapsed = std::max(1e-6, std::chrono::duration<double>(now - start_).count());
  const double rate = static_cast<double>(done - std::min(before_, done)) / elapsed;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  if (mode_ == ProgressMode::kJson) {
    write_log(fmt::format("{{\"t\":{:.1f},\"done\":{},\"total\":{},\"failed\":{},\"eta_s\":{:.0f},\"rate\":{:.1f}}}\n",
                          elapsed, done, total, failed, left, rate));
  } else if (mode_ == ProgressMode::kBar) {
    const auto text = fmt::format(" {}/{} {}, {:.0f}/s, {} left", done, total, noun_, rate, clock_text(left));
    const std::size_t width = terminal_width();
    const std::size_t room = width > text.size() + 4 ? std::min<std::size_t>(40, width - text.size() - 4) : 0;
    const auto full = room * done / std::max<std::size_t>(total, 1);
    write_log(fmt::format("\r[{}{}]{}\033[K", std::string(full, '#'), std::string(room - full, '.'), text));
    drawn_ = true;
  } else {
    const auto rest = done == total ? std::string{} : ", about " + clock_text(left) + " left";
    write_log(fmt::format("kith: info: {} of {} {}{}\n", done, total, noun_, rest));
    has_line_ = done != total;
  }
}

std::function<bool(std::size_t, std::size_t)> Progress::until_stopped() {
  return [this](std::size_t done, std::size_t total) {
    update(done, total);
    return stop_signal() == 0;
  };
}

void Progress::finish() noexcept {
  if (drawn_) write_log("\r\033[K");
  drawn_ = false;
}

}  // namespace kith::cli
