#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "connection.hpp"
#include "service_log.hpp"
#include "strands.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;

// A room in the list of all: its rows, who of it understands what, and for each seat what is not known to the room.
struct WatchedRoom {
  struct Seat {
    std::int64_t number = 0;
    std::optional<double> latency_ms{};
    std::optional<std::string> link{};
  };
  std::int64_t number = 0;
  std::shared_ptr<const Json> row, observer_row, people;
  std::vector<Seat> seats;
};

// What all who look see, and what the directory adds.
struct WatchedRooms {
  std::vector<WatchedRoom> rooms{};
  Json links{};
  std::size_t num_unsaved = 0;
};

// What facilitators and observers see. Its functions can be called from any thread; they work on a strand of its own.
class Views {
 public:
  explicit Views(ServiceState& service);

  // Who looks, and at which room; null: at none.
  void watch(const ConnectionPtr& connection);
  void select(const ConnectionPtr& connection, const std::shared_ptr<HostedRoom>& room);
  void leave(const ConnectionPtr& connection);

  // What happened.
  void changed(const std::shared_ptr<HostedRoom>& room);
  void write(LogEntry entry);
  void news();
  // Something is wrong with a room that people should hear of.
  void trouble(std::int64_t room, const std::string& what);
  // Something of a room cannot be shown, or can be again: then the problem is empty.
  void unseen(const HostedRoom& room, const std::string& what, const std::string& problem);
  // Shows what there is to show.
  void tick();
  // What facilitators read of disk and problems.
  void integrity(std::size_t num_unsaved, std::function<void(Json)> done);

 private:
  // What is known of a room without asking it. Null: not known yet; the detail also if nobody looks at it.
  struct Picture {
    std::shared_ptr<const Json> row, observer_row, detail;
  };
  // Who of a room understands what, see people_json(), after so many periods.
  struct Audit {
    std::size_t periods = 0;
    std::shared_ptr<const Json> people;
  };
  struct Watcher {
    ConnectionPtr connection;
    std::shared_ptr<HostedRoom> room;  // null: looks at none
    std::size_t ticks_awaited = 0;     // of those to come: waits for what was asked for
    bool has_rooms = false;            // has been shown the list of all rooms
  };

  void post(Strands::Job job);
  void take_picture(const std::shared_ptr<HostedRoom>& hosted);
  void keep_picture(const std::shared_ptr<HostedRoom>& hosted, Picture picture, std::size_t num_observed);
  void audit_next();
  void judge(const std::shared_ptr<HostedRoom>& hosted, const std::shared_ptr<void>& turn);
  void keep_audit(const HostedRoom& hosted, Audit audit, const std::string& problem);
  void note_unseen(const HostedRoom& room, const std::string& what, const std::string& problem);
  void show(const std::vector<std::pair<Watcher, bool>>& to_with_rooms);
  [[nodiscard]] std::vector<WatchedRoom> watched_rooms() const;
  [[nodiscard]] Json view_of(const Watcher& watcher, const WatchedRooms& watched, bool with_rooms) const;
  [[nodiscard]] Json integrity_of(std::size_t num_unsaved) const;

  ServiceState& service_;
  Strand strand_;
  std::map<LiveService::ConnectionId, Watcher> watchers_;
  std::map<std::int64_t, Picture> pictures_;
  std::map<std::int64_t, std::shared_ptr<HostedRoom>> changed_;  // whose picture is old
  bool has_news_ = false;
  std::size_t ticks_since_shown_ = 0;  // news
  std::map<std::int64_t, Audit> audits_;
  std::map<std::int64_t, std::shared_ptr<HostedRoom>> to_audit_;
  bool is_auditing_ = false;  // one room at a time: nobody's lesson waits for long
  std::size_t num_audits_ = 0;
  std::deque<LogEntry> log_;
  std::map<std::int64_t, std::string> troubles_;                        // by room
  std::map<std::pair<std::int64_t, std::string>, std::string> unseen_;  // by room, and what of it cannot be shown
};

}  // namespace kith
