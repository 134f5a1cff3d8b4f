#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "admission.hpp"
#include "connections.hpp"
#include "kith/core/live_application.hpp"
#include "net.hpp"
#include "request.hpp"
#include "send_queue.hpp"
#include "server_context.hpp"
#include "token_bucket.hpp"

namespace kith {

/// One open WebSocket. Everything but send(), close(), authenticated(), stop() and cut() happens on its strand.
class WebSocketConnection final : public ServerConnection, public std::enable_shared_from_this<WebSocketConnection> {
 public:
  WebSocketConnection(ServerContext& context, tcp::socket socket, Admission::Place place, std::string remote);
  ~WebSocketConnection() override;
  WebSocketConnection(const WebSocketConnection&) = delete;
  WebSocketConnection& operator=(const WebSocketConnection&) = delete;

  /// Says that its place is this connection's.
  void claim_place() { place_.belongs_to(weak_from_this()); }
  /// Completes the handshake and starts to read frames.
  void start(HttpMessage request);

  void send(std::shared_ptr<const std::string> frame);
  void close(std::uint16_t code, std::string reason);
  void authenticated();
  void stop() override;
  void cut() override;

 private:
  class Handle;

  void on_open(NetError error);
  void read();
  void on_read(NetError error);
  void deliver();
  void push(std::shared_ptr<const std::string> frame);
  void write_next();
  void on_written(NetError error);
  void begin_close(std::uint16_t code, const std::string& reason);
  void close_now();
  void on_control(boost::beast::websocket::frame_type kind, boost::beast::string_view payload);
  void measure();
  void arm(std::chrono::milliseconds time);
  void on_time_out();
  void finish();

  ServerContext& context_;
  tcp::socket::executor_type strand_;
  std::optional<boost::beast::websocket::stream<tcp::socket>> stream_;  // until the connection has ended
  asio::steady_timer timer_;
  std::uint64_t timer_round_ = 0;
  Admission::Place place_;
  std::string remote_;
  TokenBucket messages_;
  HttpMessage request_;
  boost::beast::flat_buffer in_;
  std::shared_ptr<Handle> handle_;
  LiveApplication::ConnectionId id_ = 0;
  bool is_open_ = false;
  bool is_known_to_application_ = false;
  bool is_authenticated_ = false;
  bool is_finished_ = false;
  bool is_closing_sent_ = false;
  bool is_pinging_ = false;                            // a ping is being written
  std::chrono::steady_clock::time_point pinged_at_{};  // when the last one was begun
  std::optional<boost::beast::websocket::close_reason> closing_;
  std::shared_ptr<const std::string> out_;  // being written
  SendQueue queue_;
};

}  // namespace kith
