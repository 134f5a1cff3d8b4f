#include "client_socket.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <random>
#include <utility>

namespace kith {

ClientSocket::ClientSocket(const boost::asio::any_io_executor& strand, Handlers handlers)
    : handlers_{std::move(handlers)}, stream_{strand} {}

void ClientSocket::connect(const tcp::endpoint& server) {
  stream_.next_layer().async_connect(server, [self = shared_from_this(), server](NetError error) {
    if (error) return self->fail();
    NetError ignored;
    self->stream_.next_layer().set_option(tcp::no_delay{true}, ignored);
    const auto host = "localhost:" + std::to_string(server.port());
    self->stream_.async_handshake(host, "/ws", [self](NetError refused) {
      if (self->is_done_) return;
      if (refused) return self->fail();
      self->is_open_ = true;
      self->handlers_.on_open();
      self->read();
      self->write_next();
    });
  });
}

void ClientSocket::send(std::string text) {
  if (is_done_) return;
  out_.push_back(std::move(text));
  write_next();
}

void ClientSocket::write_next() {
  if (!is_open_ || is_writing_ || is_done_ || out_.empty()) return;
  is_writing_ = true;
  stream_.async_write(asio::buffer(out_.front()), [self = shared_from_this()](NetError error, std::size_t) {
    self->is_writing_ = false;
    if (self->is_done_) return;
    if (error) return self->fail();
    self->out_.pop_front();
    self->write_next();
  });
}

void ClientSocket::read() {
  stream_.async_read(in_, [self = shared_from_this()](NetError error, std::size_t) {
    if (self->is_done_) return;
    if (error) return self->fail();
    const auto data = self->in_.data();
    self->handlers_.on_text({static_cast<const char*>(data.data()), data.size()});
    self->in_.consume(self->in_.size());
    if (!self->is_done_) self->read();
  });
}

void ClientSocket::fail() {
  if (is_done_) return;
  auto on_closed = std::move(handlers_.on_closed);
  cut();
  on_closed();
}

void ClientSocket::cut() {
  if (is_done_) return;
  is_done_ = true;
  NetError ignored;
  stream_.next_layer().close(ignored);
}

std::string random_prefix() {
  std::random_device device;
  return "rehearsal-" + std::to_string(device()) + "-" + std::to_string(device()) + "-";
}

}  // namespace kith
