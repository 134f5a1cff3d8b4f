#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "kith/explain/json.hpp"
#include "kith/live/room.hpp"
#include "kith/service/live_service.hpp"
#include "tokens.hpp"

namespace kith {

// Of RFC 6455; the last one of the range for applications.
constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kPolicy = 1008;
constexpr std::uint16_t kInternal = 1011;
constexpr std::uint16_t kElsewhere = 4001;

// A connection. What is behind the first blank line is set once, by its hello; then come what the strand of the
// directory owns, and what the strand owns that shows it views: of the room for participants, of the views for others.
class Connection {
 public:
  Connection(LiveService::ConnectionId number, std::shared_ptr<LiveService::Socket> to)
      : id{number}, socket{std::move(to)} {}

  const LiveService::ConnectionId id;
  const std::shared_ptr<LiveService::Socket> socket;
  std::atomic<bool> is_closed = false;

  Identity identity;

  bool is_known = false;
  std::optional<std::chrono::microseconds> round_trip;

  std::string last_view;

  void send(const Json& frame) const { socket->send(std::make_shared<const std::string>(frame.dump())); }
  void answer(const std::string& message, const std::optional<Refusal>& refusal) const;
  // Sends a view unless it is the last one, apart from the time.
  void show(Json view);
  // Says why, in a frame for the page, and closes: the page gives up.
  void dismiss(const char* reason, std::uint16_t code);
  // Closes: the page connects again.
  void hang_up(std::uint16_t code, const char* reason);
};
using ConnectionPtr = std::shared_ptr<Connection>;

}  // namespace kith
