#include "failpoint.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>

namespace kith::cli {
namespace {

extern "C" void end_at_once(int) { kill(getpid(), SIGKILL); }

// By a timer, so that the program goes on until then.
void end_in(long microseconds) {
  if (microseconds <= 0) end_at_once(0);
  struct sigaction action = {};
  action.sa_handler = end_at_once;
  sigaction(SIGALRM, &action, nullptr);
  itimerval timer = {};
  timer.it_value.tv_sec = microseconds / 1'000'000;
  timer.it_value.tv_usec = microseconds % 1'000'000;
  setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

std::function<void(const std::string& instant)> failpoint() {
  const char* value = std::getenv("KITH_FAILPOINT");
  if (value == nullptr) return {};
  const std::string text{value};
  const auto colon = text.find(':');
  if (colon == std::string::npos) return {};
  char* rest = nullptr;
  const long count = std::strtol(text.c_str() + colon + 1, &rest, 10);
  const long delay = *rest == ':' ? std::strtol(rest + 1, nullptr, 10) : 0;
  auto left = std::make_shared<std::atomic<long>>(count);
  return [name = text.substr(0, colon), left, delay](const std::string& instant) {
    if (instant == name && --*left == 0) end_in(delay);
  };
}

}  // namespace kith::cli
