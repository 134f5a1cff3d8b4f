#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "net.hpp"

namespace kith {

/// A WebSocket to a server, as a browser has one. Everything happens on the executor that it is made with, a strand.
class ClientSocket : public std::enable_shared_from_this<ClientSocket> {
 public:
  struct Handlers {
    std::function<void()> on_open;
    std::function<void(std::string_view text)> on_text;
    std::function<void()> on_closed;  ///< Once, also if it was never open; not after cut().
  };

  ClientSocket(const boost::asio::any_io_executor& strand, Handlers handlers);
  void connect(const tcp::endpoint& server);
  void send(std::string text);
  /// Drops the connection without a word, as a lost network does. No handler is called any more.
  void cut();

 private:
  void read();
  void write_next();
  void fail();

  Handlers handlers_;
  boost::beast::websocket::stream<tcp::socket> stream_;
  boost::beast::flat_buffer in_;
  std::deque<std::string> out_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool is_done_ = false;
};

/// What the ids of one client's messages begin with: another one each time, since servers remember ids for good.
[[nodiscard]] std::string random_prefix();

}  // namespace kith
