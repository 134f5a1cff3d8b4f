#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "kith/core/live_application.hpp"
#include "kith/service/server_options.hpp"

namespace kith {

/// Serves HTTP/1.1 and WebSockets on one port (RFC 9112, RFC 6455): fixed pages from memory, /api and /ws by an
/// application. Never reads a file, prints or logs; what happens is reported to ServerOptions::on_notice.
class Server {
 public:
  /// Listens and starts serving.
  /// @param application  outlives the server.
  /// @throws kith::Error: kUsage for an address that is none, kBusy if the port is in use, kIo for what else the system
  /// refuses. Fewer threads than wanted are no error, as long as there is one.
  Server(ServerOptions options, LiveApplication& application);
  /// Stops without waiting for clients.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] ServerStatus status() const;

  /// Accepts nothing new, says goodbye to every WebSocket ({"t":"bye","reason":"server-stops"}, 1001), ends connections
  /// after what they are being sent, and returns when all have ended; those that have not after `patience` are cut off.
  /// Returns at once when called again.
  void stop(std::chrono::milliseconds patience = std::chrono::milliseconds{700});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kith
