#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "admission.hpp"
#include "connections.hpp"
#include "net.hpp"
#include "reply.hpp"
#include "request_reader.hpp"
#include "server_context.hpp"

namespace kith {

/// One connection that carries HTTP requests, one after the other, until it ends or becomes a WebSocket. Everything but
/// stop() and cut() happens on the strand of its socket.
class HttpConnection final : public ServerConnection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(ServerContext& context, tcp::socket socket, Admission::Place place, std::string remote);

  /// Says that its place is this connection's.
  void claim_place() { place_.belongs_to(weak_from_this()); }
  /// Starts to read requests.
  void start();
  /// Tells a client only that it cannot be served now.
  void refuse(ServerReply reply);

  void stop() override;
  void cut() override;

 private:
  enum class Phase { kReading, kWaiting, kWriting, kLingering, kFinished };
  struct Owed;

  void begin_request();
  void read();
  void on_read(NetError error, std::size_t size);
  void advance();
  bool judge();
  void dispatch();
  void ask_application(HttpMessage request);
  void end_waiting();
  void open_web_socket(HttpMessage request);
  void answer(ServerReply reply);
  void on_written(NetError error);
  void linger();
  void finish();
  void arm(std::chrono::milliseconds time);
  void on_time_out();
  [[nodiscard]] std::string client_of(const HttpMessage& request) const;

  ServerContext& context_;
  tcp::socket socket_;
  asio::steady_timer timer_;
  std::uint64_t timer_round_ = 0;
  Admission::Place place_;
  std::string remote_;
  RequestReader reader_;
  Phase phase_ = Phase::kReading;
  bool is_judged_ = false;
  bool is_head_only_ = false;
  bool has_timed_out_ = false;
  bool is_stopping_ = false;
  bool only_refuses_ = false;
  std::size_t num_requests_ = 0;
  std::size_t num_discarded_ = 0;
  Destination destination_;
  std::shared_ptr<Owed> owed_;  // while it waits for the application
  ServerReply reply_;
  std::string head_;
  std::array<char, 4096> in_{};
};

}  // namespace kith
