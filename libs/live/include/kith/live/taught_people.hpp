#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kith/live/room.hpp"
#include "kith/teaching/observed_period.hpp"

namespace kith {

/// Somebody who has or had a place of a room's session.
struct TaughtPerson {
  std::size_t member = 0;  ///< The place, from 0.
  std::size_t seat = 0;    ///< Who had it, from 1.
  bool is_person = true;   ///< Otherwise a stand-in.
  std::vector<ObservedPeriod> periods;
};

/// Tells people apart who had the same place of a room one after the other.
class TaughtPeople {
 public:
  /// To be called after every event of the room. Who answered the tests of a period took part in it; where nobody did,
  /// who has the place at its end.
  void see(const Room& room);
  /// Completed ones so far.
  [[nodiscard]] std::size_t num_periods() const noexcept { return periods_.size(); }
  /// Everybody with a completed period, and who has a place now, by place and then in the order in which they had it.
  /// @pre see(room) was called last with this state.
  [[nodiscard]] std::vector<TaughtPerson> all(const Room& room) const;

 private:
  using Seats = std::vector<std::optional<std::size_t>>;  // by member

  std::vector<Seats> periods_;
  Seats answered_;  // the present tests
};

}  // namespace kith
