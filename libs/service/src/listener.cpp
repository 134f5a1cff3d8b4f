#include "listener.hpp"

#include <boost/asio/socket_base.hpp>
#include <chrono>
#include <string>
#include <utility>

#include "http_connection.hpp"
#include "kith/core/error.hpp"

namespace kith {
namespace {

constexpr std::chrono::milliseconds kPauseAfterFailure{100};
constexpr std::size_t kRefusing = 64;

Error error_of(const ServerOptions& options, const NetError& error) {
  const auto place = options.bind + ":" + std::to_string(options.port);
  if (error == asio::error::address_in_use) {
    return Error{ErrorKind::kBusy, "port " + std::to_string(options.port) + " of " + options.bind + " is in use",
                 Advice{"another program listens there; choose another port, or stop that program"}};
  }
  if (error == asio::error::access_denied) {
    return Error{ErrorKind::kIo, "cannot listen at " + place + ": " + error.message(),
                 Advice{"ports below 1024 need root; choose a higher one and put a reverse proxy in front"}};
  }
  return Error{ErrorKind::kIo, "cannot listen at " + place + ": " + error.message()};
}

}  // namespace

Listener::Listener(ServerContext& context, asio::io_context& io)
    : context_{context}, io_{io}, acceptor_{asio::make_strand(io)}, pause_{acceptor_.get_executor()} {
  const auto& options = context.options;
  NetError error;
  const auto address = asio::ip::make_address(options.bind, error);
  if (error) throw Error{ErrorKind::kUsage, "'" + options.bind + "' is no IP address, such as 127.0.0.1 or 0.0.0.0"};
  const tcp::endpoint endpoint{address, options.port};
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address{true}, error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw error_of(options, error);
  port_ = acceptor_.local_endpoint().port();
}

void Listener::start() {
  asio::post(acceptor_.get_executor(), [self = shared_from_this()] { self->accept(); });
}

void Listener::stop() {
  asio::post(acceptor_.get_executor(), [self = shared_from_this()] {
    NetError ignored;
    self->acceptor_.close(ignored);
    self->pause_.cancel();
  });
}

void Listener::accept() {
  if (!acceptor_.is_open()) return;
  acceptor_.async_accept(asio::make_strand(io_), [self = shared_from_this()](NetError error, tcp::socket socket) {
    self->on_accepted(error, std::move(socket));
  });
}

void Listener::on_accepted(NetError error, tcp::socket socket) {
  if (!acceptor_.is_open()) return;
  if (!error) {
    admit(std::move(socket));
    return accept();
  }
  if (error == asio::error::connection_aborted) return accept();
  context_.notice(ServerNotice::Kind::kAccept, "a connection could not be accepted: " + error.message());
  pause_.expires_after(kPauseAfterFailure);
  pause_.async_wait([self = shared_from_this()](NetError) { self->accept(); });
}

void Listener::admit(tcp::socket socket) {
  NetError error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return;  // gone already
  socket.set_option(tcp::no_delay{true}, error);
  const auto address = peer.address();
  const bool is_proxy = context_.is_proxy(address);
  Admission::Place place;
  const auto verdict = context_.admission.enter(address_group(address.to_string()), !is_proxy, place);
  if (verdict.gives_way) {
    verdict.gives_way->cut();
    context_.notice(ServerNotice::Kind::kOverload, "an idle connection was closed to make room for a new one");
  }
  const bool is_welcome = verdict.is_welcome;
  if (!is_welcome) {
    context_.notice(ServerNotice::Kind::kOverload, "a client was turned away: too many connections");
    if (context_.refusing >= kRefusing) return;
    ++context_.refusing;
  }
  const auto connection =
      std::make_shared<HttpConnection>(context_, std::move(socket), std::move(place), address.to_string());
  connection->claim_place();
  if (!context_.connections.add(connection)) {
    if (!is_welcome) --context_.refusing;
    return;
  }
  if (is_welcome) return connection->start();
  auto reply = plain_reply(503, "there are too many connections; try again in a few seconds");
  reply.headers.emplace_back("Retry-After", "5");
  connection->refuse(std::move(reply));
}

}  // namespace kith
