#include "connections.hpp"

#include <vector>

namespace kith {

bool ServerConnections::add(const std::shared_ptr<ServerConnection>& connection) {
  const std::lock_guard lock{mutex_};
  if (is_stopping_) return false;
  all_.emplace(connection.get(), connection);
  return true;
}

void ServerConnections::remove(const ServerConnection* connection) {
  const std::lock_guard lock{mutex_};
  all_.erase(connection);
  if (all_.empty()) changed_.notify_all();
}

void ServerConnections::for_all(void (ServerConnection::*action)()) {
  std::vector<std::shared_ptr<ServerConnection>> now;
  {
    const std::lock_guard lock{mutex_};
    now.reserve(all_.size());
    for (const auto& [key, connection] : all_) {
      if (auto alive = connection.lock()) now.push_back(std::move(alive));
    }
  }
  for (const auto& connection : now) (connection.get()->*action)();
}

void ServerConnections::stop_all() {
  {
    const std::lock_guard lock{mutex_};
    is_stopping_ = true;
  }
  for_all(&ServerConnection::stop);
}

void ServerConnections::cut_all() { for_all(&ServerConnection::cut); }

bool ServerConnections::wait_until_none(std::chrono::steady_clock::time_point until) {
  std::unique_lock lock{mutex_};
  return changed_.wait_until(lock, until, [this] { return all_.empty(); });
}

}  // namespace kith
