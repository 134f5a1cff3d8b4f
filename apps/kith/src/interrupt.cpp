#include "interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string_view>

#include "kith/explain/json.hpp"

namespace kith::cli {
namespace {

struct Ending {
  timespec patience;  // time for an orderly end
  std::string_view farewell;
  bool is_failure;
};
// People and schedulers expect an answer within a second.
constexpr Ending kInterrupted{
    {0, 800'000'000}, "kith: warning: interrupted in the middle of a long step; saved results are kept\n", true};
constexpr Ending kStopped{
    {3, 0}, "kith: stopped while a lesson was being chosen; every acknowledged answer is saved\n", false};

std::atomic<const Ending*> ending = &kInterrupted;
static_assert(decltype(ending)::is_always_lock_free);  // handlers read it
volatile std::sig_atomic_t received = 0;
timer_t patience = {};
volatile std::sig_atomic_t has_timer = 0;

// What follows is called by handlers: only what POSIX calls async-signal-safe.

extern "C" void on_signal(int number) {
  received = number;
  if (has_timer == 0) return;
  itimerspec once = {};
  once.it_value = ending.load()->patience;
  timer_settime(patience, 0, &once, nullptr);
}

extern "C" void on_end_of_patience(int) {
  const auto* how = ending.load();
  [[maybe_unused]] const auto written = write(STDERR_FILENO, how->farewell.data(), how->farewell.size());
  _exit(how->is_failure ? 128 + received : 0);
}

// Without a timer, of which a user can have only so many, the program still stops, only later.
bool make_timer() {
  sigevent event = {};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  if (timer_create(CLOCK_MONOTONIC, &event, &patience) != 0) return false;
  struct sigaction action = {};
  action.sa_handler = on_end_of_patience;
  sigemptyset(&action.sa_mask);
  return sigaction(SIGALRM, &action, nullptr) == 0;
}

bool is_ignored(int number) {
  struct sigaction action = {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void ignore_broken_pipes() {
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // a file that may not grow is an error of write(), too
}

void watch_signals() {
  if (has_timer == 0 && make_timer()) has_timer = 1;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  if (!is_ignored(SIGHUP)) sigaction(SIGHUP, &action, nullptr);
}

void expect_to_be_stopped() noexcept { ending = &kStopped; }

int stop_signal() noexcept { return received; }

int interrupted(const std::string& what, Console& console, const std::string& command) {
  console.warning(command.empty() ? what : what + "; to resume, run:\n  " + command);
  if (console.json()) console.print_json(error_document({{.id = "interrupted", .message = what, .hint = command}}));
  return 128 + (stop_signal() != 0 ? stop_signal() : SIGINT);
}

}  // namespace kith::cli
