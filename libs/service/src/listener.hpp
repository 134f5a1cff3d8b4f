#pragma once

#include <cstdint>
#include <memory>

#include "net.hpp"
#include "server_context.hpp"

namespace kith {

/// Accepts connections and hands them on.
class Listener : public std::enable_shared_from_this<Listener> {
 public:
  /// @throws kith::Error as Server does.
  Listener(ServerContext& context, asio::io_context& io);
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void start();
  /// From any thread.
  void stop();

 private:
  void accept();
  void on_accepted(NetError error, tcp::socket socket);
  void admit(tcp::socket socket);

  ServerContext& context_;
  asio::io_context& io_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::uint16_t port_ = 0;
};

}  // namespace kith
