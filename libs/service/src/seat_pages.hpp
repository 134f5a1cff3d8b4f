#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "connection.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;

// The seats of a room as their links lead there: who looks at the page of each. On the strand of the room.
class SeatPages {
 public:
  // Somebody has the seat, or had.
  void take(std::size_t seat) { seats_[seat].is_taken = true; }
  [[nodiscard]] bool was_taken(std::size_t seat) const;
  // This connection shows the page of the seat from now on.
  void open(std::size_t seat, const ConnectionPtr& connection) { seats_[seat].connection = connection; }
  void close(std::size_t seat, const ConnectionPtr& connection);
  // The link of this seat of the waiting list leads to a seat of this new room from now on.
  void move(std::size_t from, SeatPages& room, std::size_t to);
  // Whether the link leads elsewhere: the directory knows where.
  [[nodiscard]] bool has_moved(std::size_t seat) const;

  // Shows everybody what has become of the room.
  void show(HostedRoom& hosted);
  void show(HostedRoom& hosted, std::size_t seat, Connection& connection);

 private:
  struct Seat {
    ConnectionPtr connection;
    bool is_taken = false;
    bool has_moved = false;
  };
  std::map<std::size_t, Seat> seats_;
};

}  // namespace kith
