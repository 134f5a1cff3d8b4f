#pragma once

#include <vector>

#include "kith/store/event_file.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;

// The waiting list: people are screened there, and each group that can be formed of them gets a room of its own. On the
// strand of the room that it is.
class WaitingList {
 public:
  explicit WaitingList(ServiceState& service) : service_{service} {}

  // Its room, if the study has one and it is not there yet; before there are threads. @throws kith::Error
  void make();
  // It has nothing to do at the moment: a group may be formed.
  void form_group(HostedRoom& list);

 private:
  // People have places in a new room, which is saved.
  void seat_group(HostedRoom& list, const StoredRoom& stored, const std::vector<StoredEvent>& events);

  ServiceState& service_;
  bool is_forming_ = false;
};

}  // namespace kith
