#include "seat_pages.hpp"

#include <utility>

#include "service_state.hpp"

namespace kith {

bool SeatPages::was_taken(std::size_t seat) const {
  const auto found = seats_.find(seat);
  return found != seats_.end() && found->second.is_taken;
}

bool SeatPages::has_moved(std::size_t seat) const {
  const auto found = seats_.find(seat);
  return found != seats_.end() && found->second.has_moved;
}

void SeatPages::close(std::size_t seat, const ConnectionPtr& connection) {
  const auto found = seats_.find(seat);
  if (found != seats_.end() && found->second.connection == connection) found->second.connection = nullptr;
}

void SeatPages::move(std::size_t from, SeatPages& room, std::size_t to) {
  room.seats_[to] = {.connection = std::exchange(seats_[from].connection, nullptr), .is_taken = true};
  seats_[from].has_moved = true;
}

void SeatPages::show(HostedRoom& hosted) {
  const auto* room = hosted.room();
  if (room == nullptr) return;
  for (const auto& [number, seat] : seats_) {
    if (seat.connection && number <= room->num_seats() && room->is_person(number))
      show(hosted, number, *seat.connection);
  }
}

// If there is no page, that ends the connection and nothing else.
void SeatPages::show(HostedRoom& hosted, std::size_t seat, Connection& connection) {
  if (connection.is_closed) return;
  const Viewer viewer{.role = Viewer::Role::kParticipant, .seat = seat};
  const bool is_shown = hosted.can_show("page of seat " + std::to_string(seat), [&] {
    connection.show(hosted.room()->view(viewer, hosted.service().now_us()));
  });
  if (!is_shown) connection.dismiss("no-view", kGoingAway);
}

}  // namespace kith
