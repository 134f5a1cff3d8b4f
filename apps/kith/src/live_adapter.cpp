#include "live_adapter.hpp"

#include <utility>

namespace kith::cli {
namespace {

class Forward final : public LiveService::Socket {
 public:
  explicit Forward(std::shared_ptr<LiveApplication::Socket> socket) : socket_{std::move(socket)} {}

  void send(std::shared_ptr<const std::string> frame) override { socket_->send(std::move(frame)); }
  void close(std::uint16_t code, std::string reason) override { socket_->close(code, std::move(reason)); }
  void authenticated() override { socket_->authenticated(); }

 private:
  std::shared_ptr<LiveApplication::Socket> socket_;
};

}  // namespace

LiveAdapter::ConnectionId LiveAdapter::open(std::shared_ptr<Socket> socket, std::string /*remote*/) {
  return service_.open(std::make_shared<Forward>(std::move(socket)));
}

void LiveAdapter::receive(ConnectionId connection, std::string_view frame) { service_.receive(connection, frame); }

void LiveAdapter::measured(ConnectionId connection, std::chrono::microseconds round_trip) {
  service_.measured(connection, round_trip);
}

void LiveAdapter::closed(ConnectionId connection) { service_.closed(connection); }

LiveAdapter::HttpReply LiveAdapter::http(const HttpRequest& request) {
  auto reply = service_.http({.method = request.method,
                              .target = request.target,
                              .bearer = request.bearer,
                              .body = request.body,
                              .remote = request.remote});
  return {.status = reply.status,
          .content_type = std::move(reply.content_type),
          .body = std::move(reply.body),
          .headers = std::move(reply.headers)};
}

}  // namespace kith::cli
