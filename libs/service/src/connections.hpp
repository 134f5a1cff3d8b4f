#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace kith {

/// A connection of either kind, as whoever stops the server sees it. Both functions can be called from any thread.
class ServerConnection {
 public:
  ServerConnection() = default;
  ServerConnection(const ServerConnection&) = delete;
  ServerConnection& operator=(const ServerConnection&) = delete;
  virtual ~ServerConnection() = default;
  /// Ends it in an orderly way.
  virtual void stop() = 0;
  /// Ends it now.
  virtual void cut() = 0;
};

/// The connections that there are. Thread-safe.
class ServerConnections {
 public:
  /// @return false if the server is stopping: the connection must end.
  [[nodiscard]] bool add(const std::shared_ptr<ServerConnection>& connection);
  void remove(const ServerConnection* connection);
  /// Lets no further connection in, and stops all.
  void stop_all();
  void cut_all();
  /// @return whether there are none any more.
  bool wait_until_none(std::chrono::steady_clock::time_point until);

 private:
  void for_all(void (ServerConnection::*action)());

  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_stopping_ = false;
  std::unordered_map<const ServerConnection*, std::weak_ptr<ServerConnection>> all_;
};

}  // namespace kith
