#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "net.hpp"

namespace kith {

/// Threads that run handlers. Where the system refuses some of them (for which asio::thread_pool would wait for ever),
/// those that it grants do the work.
class Threads {
 public:
  /// @param on_error  is told what handlers throw; without it that ends the program.
  /// @throws kith::Error (kIo) if the system grants none.
  explicit Threads(std::size_t wanted, std::function<void(const std::exception&)> on_error = {});
  ~Threads() { stop(); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  [[nodiscard]] asio::io_context& io() noexcept { return io_; }
  [[nodiscard]] std::size_t size() const noexcept { return threads_.size(); }
  /// Ends the handlers that run, and drops the others. May be called twice.
  void stop();

 private:
  void run();

  std::function<void(const std::exception&)> on_error_;
  asio::io_context io_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  std::vector<std::jthread> threads_;
};

}  // namespace kith
