#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace kith {

/// What a server serves besides fixed pages: an application that speaks through WebSockets and answers requests
/// below /api. Servers and applications know each other by this only. Called from several threads at once.
class LiveApplication {
 public:
  /// One connected page, as the application sees it. All functions can be called from any thread and never block.
  class Socket {
   public:
    Socket() = default;
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    virtual ~Socket() = default;
    /// Queues a text frame. A client that reads too slowly is disconnected (see ServerLimits::queued_frames).
    virtual void send(std::shared_ptr<const std::string> frame) = 0;
    /// Sends what is queued, then closes with this code (RFC 6455, 7.4) and reason (at most 123 bytes are sent).
    virtual void close(std::uint16_t code, std::string reason) = 0;
    /// The client has said who it is: it no longer counts as unauthenticated.
    virtual void authenticated() {}
  };
  using ConnectionId = std::uint64_t;

  struct HttpRequest {
    std::string method;  ///< "GET" or "POST"; HEAD arrives as GET.
    std::string target;  ///< Path and query, as sent.
    std::string bearer;  ///< The token of `Authorization: Bearer TOKEN`, or empty.
    std::string body;    ///< JSON that nests no deeper than ServerLimits::json_depth, or empty.
    std::string remote;  ///< The client's address, for limits.
  };
  struct HttpReply {
    int status = 200;
    std::string content_type = "application/json";
    std::string body{};
    std::map<std::string, std::string> headers{};  ///< Others than type, length and those that every reply has.
  };

  LiveApplication() = default;
  LiveApplication(const LiveApplication&) = delete;
  LiveApplication& operator=(const LiveApplication&) = delete;
  virtual ~LiveApplication() = default;

  /// A WebSocket was opened. `socket` may be kept as long as wanted; once closed, its functions do nothing.
  virtual ConnectionId open(std::shared_ptr<Socket> socket, std::string remote) = 0;
  /// A text frame arrived. Must not block. Calls for one connection never overlap.
  virtual void receive(ConnectionId connection, std::string_view frame) = 0;
  /// How long a ping to the client and back took: now and then, while the client says something. Must not block.
  virtual void measured(ConnectionId, std::chrono::microseconds) {}
  /// The connection has ended. Called once for every open().
  virtual void closed(ConnectionId connection) = 0;
  /// Takes the answer to a request: from any thread, once, also when nobody waits for it any more.
  using HttpAnswer = std::function<void(HttpReply reply)>;
  /// Has a request below /api answered, now or later. Must not block.
  virtual void http(HttpRequest request, HttpAnswer answer) = 0;
};

}  // namespace kith
