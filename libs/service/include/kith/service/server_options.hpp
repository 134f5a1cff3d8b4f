#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kith/service/asset.hpp"

namespace kith {

/// What one client may take up. The defaults are those of docs/security.md.
struct ServerLimits {
  std::size_t header_bytes = 8 * 1024;
  std::size_t target_bytes = 2048;
  std::size_t body_bytes = 64 * 1024;
  std::size_t frame_bytes = 16 * 1024;  ///< Of one WebSocket message, in however many fragments.
  std::size_t json_depth = 32;
  std::size_t queued_frames = 256;  ///< Frames waiting for a slow client; one more, and it is disconnected (1013).
  std::size_t queued_bytes = 1024 * 1024;
  double messages_per_second = 30.0;  ///< Per WebSocket, control frames included.
  double message_burst = 60.0;
  /// Sockets without a valid token. Beyond it, and beyond `sockets`, the one that has gone for longest without a
  /// complete request is closed.
  std::size_t unauthenticated_per_address = 1024;
  std::size_t sockets = 4096;  ///< In all; if all of them have shown a token, further ones are answered with 503.
  std::size_t waiting_requests = 256;  ///< Requests below /api that wait for their answer; further ones get 503.
  std::chrono::milliseconds header_time{10'000};
  std::chrono::milliseconds body_time{20'000};
  std::chrono::milliseconds hello_time{5'000};
  std::chrono::milliseconds keep_alive_time{15'000};  ///< Between two requests of one connection.
  std::chrono::milliseconds idle_time{30'000};        ///< Of a WebSocket from which nothing comes, not even a pong.
  std::chrono::milliseconds close_time{2'000};        ///< For the client's part in closing.
};

/// What the server reports while it runs.
struct ServerNotice {
  enum class Kind {
    kThreads,   ///< The system granted fewer threads than wanted.
    kAccept,    ///< A connection could not be accepted; the server tries again.
    kOverload,  ///< A client was turned away because there are too many.
    kFailure,   ///< The application threw, or the server has a bug.
  };
  Kind kind;
  std::string text;
};

/// Where and how to serve.
struct ServerOptions {
  std::string bind = "127.0.0.1";  ///< An address, not a name.
  std::uint16_t port = 0;          ///< 0: any free port.
  std::size_t io_threads = 2;
  /// Names and addresses (without a port) by which clients may call this server, besides the loopback ones. A request
  /// whose Host is another is refused with 421: a page of somebody else's whose name resolves to this machine must not
  /// be able to talk to it (DNS rebinding).
  std::vector<std::string> hosts{};
  /// Origins ("https://study.example.org") of pages that may talk to this server besides its own.
  std::vector<std::string> origins{};
  /// A reverse proxy on this machine passes the clients on: connections from a loopback address name the client in
  /// X-Forwarded-For, and limits per address do not apply to the proxy itself. X-Forwarded-For of anybody else is
  /// ignored.
  bool behind_proxy = false;
  std::string proxy{};  ///< With behind_proxy: the address of the proxy, if it is on another machine.
  std::span<const Asset> assets{};
  std::map<std::string, std::string> pages{};  ///< Path of a page, "/j", and of the asset it is, "/assets/live/...".
  ServerLimits limits{};
  std::function<void(const ServerNotice&)> on_notice{};  ///< Called from any thread. Must not throw.
};

/// Counts since the start, and of what is there now.
struct ServerStatus {
  std::size_t connections = 0;     ///< Open now, of either kind.
  std::size_t web_sockets = 0;     ///< Open now.
  std::uint64_t requests = 0;      ///< Answered, refused ones included.
  std::uint64_t turned_away = 0;   ///< Connections refused or closed by a limit on sockets.
  std::uint64_t slow_clients = 0;  ///< Disconnected because they did not read what was sent.
};

}  // namespace kith
