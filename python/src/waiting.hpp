#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <optional>
#include <type_traits>
#include <utility>

#include "binding.hpp"

namespace kith::python {

/// How far long work is, and whether it is to end: shared by the work and whoever waits for it.
struct Watch {
  std::atomic<bool> stop{false};
  std::atomic<std::size_t> done{0}, total{0}, failed{0};

  void tell(std::size_t now_done, std::size_t now_total, std::size_t now_failed = 0) {
    done = now_done;
    total = now_total;
    failed = now_failed;
  }
};

/// Thrown by work that was told to stop where it has no other way to end.
struct Stopped : std::exception {};

/// Does the work on a thread of its own while this one waits without the interpreter's lock, answers signals such as
/// Ctrl-C, and tells `on_progress` (done, total, failed) unless that is None. What the signal or on_progress raised is
/// raised once the work, told by Watch::stop, has ended.
template <typename Work>
std::invoke_result_t<Work> wait_for(Watch& watch, const py::object& on_progress, Work work) {
  constexpr std::chrono::milliseconds kPause{50};
  auto future = std::async(std::launch::async, std::move(work));
  std::optional<py::error_already_set> raised;
  std::size_t told = 0;
  const auto tell = [&] {
    const std::size_t done = watch.done, total = watch.total;
    if (on_progress.is_none() || total == 0 || done == told) return;
    told = done;
    on_progress(done, total, watch.failed.load());
  };
  for (bool ready = false; !ready;) {
    {
      const py::gil_scoped_release unlocked;
      ready = future.wait_for(kPause) == std::future_status::ready;
    }
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
      tell();
    } catch (const py::error_already_set& error) {
      raised = error;
      watch.stop = true;
    }
  }
  const auto get = [&] {
    const py::gil_scoped_release unlocked;  // the thread may need the lock to end
    return future.get();
  };
  if (!raised) return get();
  try {
    (void)get();
  } catch (...) {  // because it was stopped
  }
  throw *raised;
}

/// The same without progress.
template <typename Work>
std::invoke_result_t<Work> wait_for(Work work) {
  Watch watch;
  return wait_for(watch, py::none(), std::move(work));
}

}  // namespace kith::python
