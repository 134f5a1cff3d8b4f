#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "client_socket.hpp"
#include "kith/explain/json.hpp"
#include "net.hpp"

namespace kith {

/// The facilitator of a rehearsal. Its functions wait, so they are called by a thread that runs no handlers.
class BotFacilitator {
 public:
  struct Room {
    std::string id;
    std::vector<std::string> tokens;  ///< Of the people's seats.
  };

  BotFacilitator(asio::io_context& io, const tcp::endpoint& server, std::string token);
  ~BotFacilitator();
  BotFacilitator(const BotFacilitator&) = delete;
  BotFacilitator& operator=(const BotFacilitator&) = delete;

  /// Makes rooms as the study says. @throws kith::Error (kIo) if that fails.
  /// @param earlier  ids of rooms that were made before; the server may not show all of them yet if it was restarted.
  [[nodiscard]] std::vector<Room> make_rooms(std::size_t count, std::set<std::string> earlier = {});
  /// Asks for the end of rooms, at a pace that the server allows, and waits for the replies.
  void end_rooms(const std::vector<Room>& rooms);
  /// Opens the page of a room, once there is a connection.
  void look_at(const std::string& room);
  /// Whether the server or the network has ended the connection.
  [[nodiscard]] bool is_closed() const;
  /// What the last view says is wrong.
  [[nodiscard]] std::vector<std::string> problems() const;

 private:
  struct Shared;
  void say(const std::string& type, Json body);
  [[nodiscard]] bool wait(std::chrono::milliseconds time, const std::function<bool()>& holds);

  std::shared_ptr<Shared> shared_;
};

}  // namespace kith
