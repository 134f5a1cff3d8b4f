#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kith/explain/json.hpp"
#include "kith/live/room.hpp"
#include "kith/store/event_file.hpp"
#include "strands.hpp"

namespace kith {

struct ServiceState;

// An entry of the facilitator's log.
struct LogEntry {
  std::int64_t at_us = 0;
  std::string room;
  std::string actor;
  std::string what;
  std::string reason;
};

// Whether facilitators read of an event in their log: what they did, and who came and went.
[[nodiscard]] bool is_logged(std::string_view actor, std::string_view type);
// @param room  0: of the service.
[[nodiscard]] LogEntry log_entry(std::int64_t room, std::int64_t at_us, const std::string& actor,
                                 const std::string& type, const Json& body);

// What happens outside of rooms, as room 0 of the store. On the strand of the desk.
class ServiceLog {
 public:
  using Reply = std::function<void(const std::optional<Refusal>& refusal)>;

  explicit ServiceLog(ServiceState& service) : service_{service} {}

  // An event of the store.
  void load(const StoredEvent& event);
  // Has something written down, together with the rest of the batch.
  void record(StoreBatch batch, const std::string& actor, const std::string& type, const Json& body,
              const std::string& message = {}, std::function<void(bool saved)> done = {});
  // Carries out a facilitator's message: once, however often it is sent.
  void carry_out(const std::string& id, Reply reply, const std::function<void(Reply)>& act);

 private:
  ServiceState& service_;
  std::uint64_t next_seq_ = 1;
  Turns turns_;                                     // an event gets its number when the one before is saved
  std::set<std::string> seen_;                      // ids of messages that are carried out
  std::map<std::string, std::vector<Reply>> open_;  // who waits for one that is being carried out
};

}  // namespace kith
