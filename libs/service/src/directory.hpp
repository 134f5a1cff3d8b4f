#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "connection.hpp"
#include "service_log.hpp"
#include "tokens.hpp"
#include "views.hpp"

namespace kith {

class HostedRoom;
struct ServiceState;

// A seat of a room.
using Place = std::pair<std::int64_t, std::int64_t>;

// Who and what there is: rooms, links and where they lead, connections, and what these ask for. On the strand of the
// desk, but for what says otherwise.
class Directory {
 public:
  explicit Directory(ServiceState& service) : service_{service} {}

  // Rooms.
  void add(const std::shared_ptr<HostedRoom>& room);
  [[nodiscard]] std::shared_ptr<HostedRoom> room_of(std::int64_t number) const;
  // By id or code; null if there is none.
  [[nodiscard]] std::shared_ptr<HostedRoom> room_named(const std::string& name) const;
  [[nodiscard]] const auto& rooms() const noexcept { return rooms_; }
  // Its number; 0: there is none. Set before there are threads.
  [[nodiscard]] std::int64_t waiting_list() const noexcept { return waiting_list_; }
  // From any thread: all rooms but the waiting list.
  [[nodiscard]] std::size_t num_groups() const noexcept { return num_groups_; }

  // Links.
  void add(const StoredToken& link) { tokens_.add(link); }
  void add(const Tokens::Issued& link) { tokens_.add(link); }
  void set_base_url(std::string url);
  void set_links(std::string facilitator, std::string observer);
  [[nodiscard]] Identity identify(const std::string& token) const;
  // A new link for a seat, once it is on the disk; empty if it cannot be saved. Those that it replaces are void.
  void make_link(const Place& place, bool replaces, std::function<void(const std::string& token)> made);

  // People.
  void joined(const Place& place);
  // Somebody's link leads to another seat from now on.
  void move(const Place& from, const Place& to);
  // Who joined with this query has this seat. What the query says is stored with the consent.
  void seat(const Place& place, const std::string& person, const Json& query);
  [[nodiscard]] std::optional<Place> seat_of(const std::string& person) const;
  // What the events of a room say of who sits where.
  /// Whether note() makes anything of events of a type.
  [[nodiscard]] static bool notes(std::string_view type);
  void note(std::int64_t room, const std::string& actor, const std::string& type, const Json& body);

  // Connections.
  void open(const ConnectionPtr& connection);
  void receive(LiveService::ConnectionId id, const std::optional<Json>& frame);
  void measured(LiveService::ConnectionId id, std::chrono::microseconds round_trip);
  void closed(LiveService::ConnectionId id);
  void say_goodbye();

  void tick();
  // Adds what facilitators see of people without asking rooms.
  void fill(WatchedRooms& watched) const;
  [[nodiscard]] std::size_t num_unsaved() const;

 private:
  // What connects a seat to whoever sits there.
  struct Contact {
    ConnectionPtr connection;
    std::int64_t last_seen_us = 0;
    bool is_away = false;  // and the room was told so
  };

  [[nodiscard]] Place place_of(const Identity& identity) const;
  void receive(const ConnectionPtr& connection, const std::optional<Json>& frame);
  void hello(const ConnectionPtr& connection, const Json& frame);
  void beat(const Connection& connection);
  void message(const ConnectionPtr& connection, const std::string& type, const Json& frame);
  void attend(const ConnectionPtr& connection);
  void tell_room(const ConnectionPtr& connection, const std::string& type, const std::string& id, const Json& body);
  void facilitate(const ConnectionPtr& connection, const std::string& type, const std::string& id, const Json& body);
  void select(const ConnectionPtr& connection, const Json& body, const ServiceLog::Reply& reply);
  void ask_room(const Json& body, const std::string& type, const std::string& id, const ServiceLog::Reply& reply);
  void revoke_link(const std::string& id, const Json& body, const ServiceLog::Reply& reply);
  void tell_presence(const Place& place, const char* type) const;
  void check_presence(std::int64_t now);
  [[nodiscard]] std::optional<std::string> link_of(const Place& place) const;

  ServiceState& service_;
  std::map<std::int64_t, std::shared_ptr<HostedRoom>> rooms_;
  std::atomic<std::size_t> num_groups_ = 0;
  std::int64_t waiting_list_ = 0;
  Tokens tokens_;
  std::string base_url_, facilitator_token_, observer_token_;
  std::map<Place, Contact> contacts_;            // of people
  std::map<Place, Place> moved_;                 // from the waiting list to a group: whose links lead there now
  std::map<Place, Place> came_from_;             // the reverse
  std::map<std::string, Place> seat_of_person_;  // by platform_id() what a platform says of them
  std::map<Place, Json> queries_;                // of people who have not consented yet
  std::map<LiveService::ConnectionId, ConnectionPtr> connections_;
};

}  // namespace kith
