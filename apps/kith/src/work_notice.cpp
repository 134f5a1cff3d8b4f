#include "work_notice.hpp"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>

#include "kith/explain/curriculum.hpp"

namespace kith::cli {

WorkNotice::WorkNotice(const Console& console, std::string what) {
  if (console.quiet() || !console.log_is_terminal()) return;
  const auto wait = [line = "kith: info: " + std::move(what) +
                            " takes a while; press Ctrl-C to stop it\n"](std::stop_token end) {
    constexpr std::chrono::seconds kPatience{2};
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock{mutex};
    if (ended.wait_for(lock, end, kPatience, [&] { return end.stop_requested(); })) return;
    [[maybe_unused]] const auto written = write(STDERR_FILENO, line.data(), line.size());  // gone: nobody waits
  };
  try {
    waiter_ = std::jthread{wait};
  } catch (const std::system_error&) {
    // No thread to be had: the work is done all the same.
  }
}

Atlas planned(const Domain& domain, const Console& console) {
  const WorkNotice notice{console, "planning " + domain.id()};
  Atlas atlas{domain};
  require_something_to_teach(atlas);
  return atlas;
}

}  // namespace kith::cli
