#include "threads.hpp"

#include <system_error>
#include <utility>

#include "kith/core/error.hpp"

namespace kith {

Threads::Threads(std::size_t wanted, std::function<void(const std::exception&)> on_error)
    : on_error_{std::move(on_error)}, work_{io_.get_executor()} {
  try {
    while (threads_.size() < wanted) threads_.emplace_back([this] { run(); });
  } catch (const std::system_error&) {  // a limit on processes or memory
    if (threads_.empty())
      throw Error{ErrorKind::kIo, "the system grants no thread", Advice{"raise the limit on processes (ulimit -u)"}};
  }
}

void Threads::run() {
  while (!io_.stopped()) {
    try {
      io_.run();
    } catch (const std::exception& error) {
      if (!on_error_) throw;
      on_error_(error);
    }
  }
}

void Threads::stop() {
  io_.stop();
  threads_.clear();
}

}  // namespace kith
