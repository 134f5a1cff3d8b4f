#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "admission.hpp"
#include "connections.hpp"
#include "kith/core/live_application.hpp"
#include "kith/service/server_options.hpp"
#include "net.hpp"
#include "request_rules.hpp"

namespace kith {

/// What the connections of one server share.
struct ServerContext {
  ServerContext(ServerOptions how, LiveApplication& what)
      : options{std::move(how)},
        application{what},
        rules{options},
        admission{options.limits.sockets, options.limits.unauthenticated_per_address} {}

  /// Whether X-Forwarded-For of this peer is believed.
  [[nodiscard]] bool is_proxy(const asio::ip::address& peer) const {
    if (!options.behind_proxy) return false;
    if (options.proxy.empty()) return peer.is_loopback();
    return address_group(peer.to_string()) == address_group(options.proxy);
  }

  void notice(ServerNotice::Kind kind, const std::string& text) const {
    if (options.on_notice) options.on_notice({kind, text});
  }

  ServerOptions options;
  LiveApplication& application;
  RequestRules rules;
  Admission admission;
  ServerConnections connections;
  std::atomic<std::size_t> web_sockets{0};
  std::atomic<std::size_t> refusing{0};          ///< ServerConnections that are only told that there are too many.
  std::atomic<std::size_t> waiting_requests{0};  ///< For the application's answer.
  std::atomic<std::uint64_t> requests{0};
  std::atomic<std::uint64_t> slow_clients{0};
};

}  // namespace kith
