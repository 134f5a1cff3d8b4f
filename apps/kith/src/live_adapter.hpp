#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "kith/hosting/live_service.hpp"
#include "kith/server/live_application.hpp"

namespace kith::cli {

/// A LiveService as the server's application.
class LiveAdapter final : public LiveApplication {
 public:
  /// @param service  outlives the adapter.
  explicit LiveAdapter(LiveService& service) : service_{service} {}

  ConnectionId open(std::shared_ptr<Socket> socket, std::string remote) override;
  void receive(ConnectionId connection, std::string_view frame) override;
  void measured(ConnectionId connection, std::chrono::microseconds round_trip) override;
  void closed(ConnectionId connection) override;
  HttpReply http(const HttpRequest& request) override;

 private:
  LiveService& service_;
};

}  // namespace kith::cli
