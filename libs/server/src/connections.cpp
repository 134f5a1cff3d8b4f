#include "connections.hpp"

#include <vector>

namespace kith {

bool Connections::add(const std::shared_ptr<Connection>& connection) {
  const std::lock_guard lock{mutex_};
  if (is_stopping_) return false;
  all_.emplace(connection.get(), connection);
  return true;
}

void Connections::remove(const Connection* connection) {
  const std::lock_guard lock{mutex_};
  all_.erase(connection);
  if (all_.empty()) changed_.notify_all();
}

void Connections::for_all(void (Connection::*action)()) {
  std::vector<std::shared_ptr<Connection>> now;
  {
    const std::lock_guard lock{mutex_};
    now.reserve(all_.size());
    for (const auto& [key, connection] : all_) {
      if (auto alive = connection.lock()) now.push_back(std::move(alive));
    }
  }
  for (const auto& connection : now) (connection.get()->*action)();
}

void Connections::stop_all() {
  {
    const std::lock_guard lock{mutex_};
    is_stopping_ = true;
  }
  for_all(&Connection::stop);
}

void Connections::cut_all() { for_all(&Connection::cut); }

bool Connections::wait_until_none(std::chrono::steady_clock::time_point until) {
  std::unique_lock lock{mutex_};
  return changed_.wait_until(lock, until, [this] { return all_.empty(); });
}

}  // namespace kith
