#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kith/live/room.hpp"
#include "strands.hpp"
#include "tokens.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;

// "r12" for room 12, and back; 0 for anything else.
[[nodiscard]] std::string room_id(std::int64_t number);
[[nodiscard]] std::int64_t room_number(const std::string& id);

// What a facilitator asks for when making rooms.
struct RoomWish {
  std::string strategy{};
  std::vector<std::string> seats{};  // "person" or a letter for each; none: as the study says
  std::size_t count = 1;
};

// Numbers rooms, and the replicates of each cell of the design. Thread-safe.
class RoomNumbers {
 public:
  // There is this room already.
  void count(std::int64_t number, const RoomSetup& setup);
  // A room as wished, of the cell that has the fewest.
  [[nodiscard]] RoomSetup setup_for(const LiveStudy& study, const RoomWish& wish);
  // A room of this cell, with code and salt.
  [[nodiscard]] RoomSetup setup_for(const std::string& strategy, const std::string& composition,
                                    std::vector<bool> simulated);

 private:
  [[nodiscard]] RoomSetup enrolled(RoomSetup setup);

  std::mutex mutex_;
  std::int64_t next_ = 1;
  std::map<std::string, std::size_t> made_;  // by "strategy/composition"
};

// Makes rooms. On the strand of the desk, but what takes time is done on one of its own.
class RoomMaker {
 public:
  // The rooms, or why there are none.
  struct Made {
    std::vector<std::shared_ptr<HostedRoom>> rooms{};
    std::vector<std::string> tokens{};  // of the links of people
    std::optional<Refusal> refusal{};
  };
  using Done = std::function<void(const Made&)>;
  static constexpr std::size_t kMostAtOnce = 200;

  explicit RoomMaker(ServiceState& service);

  void make(const Json& body, const std::string& actor, const std::string& message, Done done);
  [[nodiscard]] RoomNumbers& numbers() noexcept { return numbers_; }

 private:
  struct Batch;
  void build(Batch& batch);
  void save(const std::shared_ptr<Batch>& batch);

  ServiceState& service_;
  Strand strand_;
  RoomNumbers numbers_;
};

}  // namespace kith
