#include "interrupt.hpp"

#include <csignal>

namespace kith::cli {
namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int number) { received = number; }

}  // namespace

void ignore_broken_pipes() {
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // a file that may not grow is an error of write(), too
}

void watch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
}

int stop_signal() noexcept { return received; }

}  // namespace kith::cli
