#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "busy_count.hpp"
#include "hosted_room.hpp"
#include "kith/service/authorisation.hpp"
#include "kith/service/live_service.hpp"
#include "kith/store/event_store.hpp"
#include "strands.hpp"
#include "teaching_pool.hpp"
#include "tokens.hpp"

namespace kith {

constexpr std::uint16_t kGoingAway = 1001;  // of RFC 6455

// A connection. What is behind the first blank line is set once, by its hello; what is behind the second is touched on
// one strand only: that of the room for participants, that of the service for others.
struct Connection {
  LiveService::ConnectionId id = 0;
  std::shared_ptr<LiveService::Socket> socket;

  Identity identity;
  std::atomic<bool> is_known = false;
  std::atomic<bool> is_closed = false;

  std::string last_view;

  // Guarded by the mutex of the service.
  std::int64_t selected = 0;  // the room that a facilitator looks at
  std::optional<std::chrono::microseconds> round_trip;

  void send(const Json& frame) const { socket->send(std::make_shared<const std::string>(frame.dump())); }
  // Says why, in a frame for the page, and closes: the page gives up.
  void dismiss(const char* reason, std::uint16_t code);
  // Closes: the page connects again.
  void hang_up(std::uint16_t code, const char* reason);
};

// What connects a seat to whoever sits there.
struct SeatContact {
  LiveService::ConnectionId connection = 0;  // 0: none
  std::int64_t last_seen_us = 0;
  bool is_away = false;  // and the room was told so
};

// What facilitators see of a room without asking it.
struct RoomPicture {
  std::shared_ptr<const Json> row, observer_row;        // null: not known yet
  std::shared_ptr<const Json> detail, observer_detail;  // null unless somebody looks at it
};

// An entry of the facilitator's log.
struct LogEntry {
  std::int64_t at_us = 0;
  std::string room;
  std::string actor;
  std::string what;
  std::string reason;
};

// A seat of a room.
using Place = std::pair<std::int64_t, std::int64_t>;

// The service's own strand is 0; that of room n is n.
struct LiveService::State final : HostedRoom::Host {
  State(std::shared_ptr<const LiveStudy> live_study, LiveServiceOptions service_options);

  std::shared_ptr<const LiveStudy> study;
  LiveServiceOptions options;
  std::function<std::int64_t()> clock;
  std::string join_code;

  BusyCount busy;
  std::unique_ptr<EventStore> store;

  // --- guarded by mutex --------------------------------------------------------
  mutable std::mutex mutex;
  std::string base_url;
  std::optional<Tokens> tokens;
  std::map<ConnectionId, std::shared_ptr<Connection>> connections;
  ConnectionId next_connection = 1;
  std::map<Place, SeatContact> contacts;  // of people
  std::set<Place> joined;                 // seats that were taken at least once
  std::map<Place, Place> moved;           // from the waiting list to a group: whose links lead there now
  std::map<Place, Place> came_from;       // the reverse
  std::map<std::int64_t, std::shared_ptr<HostedRoom>> rooms;
  std::int64_t next_room = 1;
  std::map<std::string, std::size_t> rooms_of;  // how many were made, by "strategy/composition"
  std::map<std::int64_t, RoomPicture> pictures;
  std::set<std::int64_t> changed_rooms;  // whose picture is old
  bool has_news = false;                 // for facilitators
  std::size_t ticks_since_shown = 0;     // news to them
  std::size_t ticks_awaited = 0;         // of those to come: a facilitator waits for what they asked for
  std::multiset<std::int64_t> selected;  // rooms that facilitators look at
  // Who of a room understands what, see people_json(), after so many periods.
  struct RoomAudit {
    std::size_t periods = 0;
    std::shared_ptr<const Json> people;
  };
  std::map<std::int64_t, RoomAudit> audits;
  std::set<std::int64_t> to_audit;
  std::atomic<bool> is_auditing = false;  // one room at a time: nobody's lesson waits for long
  std::deque<LogEntry> log;
  std::map<std::int64_t, std::string> troubles;                        // by room
  std::map<std::pair<std::int64_t, std::string>, std::string> unseen;  // by room, and what of it cannot be shown
  std::map<std::string, std::deque<std::int64_t>> joins;               // by address, when
  std::map<std::string, std::deque<std::int64_t>> wrong_codes;         // the same of codes that do not exist
  // By room and seat: query parameters of people who have not consented yet. They are stored with the consent.
  std::map<Place, Json> queries;
  std::map<std::string, Place> seat_of_person;  // by person_of() what a platform says of them: the seat that they took
  std::map<std::string, std::shared_ptr<const std::string>> worlds;
  std::string facilitator_token, observer_token;
  std::size_t num_facilitators = 0;
  std::uint64_t free_space = 0;
  std::int64_t looked_at_space_us = 0;
  bool is_stopping = false;

  // Held while a seat is looked for, before the other one: people who come at the same moment share rooms.
  std::mutex joining;

  // --- set by the constructor -----------------------------------------------------------
  std::int64_t waiting_list = 0;  // its number; 0: there is none

  // --- touched on the strand of the waiting list --------------------------------------
  bool is_forming = false;  // a group

  // --- touched on the service's strand -------------------------------------------
  std::uint64_t next_service_seq = 1;
  using Reply = std::function<void(const std::optional<Refusal>& refusal)>;
  std::set<std::string> seen_messages;                      // ids of facilitators' messages that are carried out
  std::map<std::string, std::vector<Reply>> open_messages;  // who waits for one that is being carried out
  struct Recording {
    StoreBatch batch;  // with one event of room 0, whose number is given when its turn comes
    std::function<void(bool saved)> done;
  };
  std::deque<Recording> recordings;
  bool is_recording = false;

  // --- threads; destroyed first -----------------------------------------------------
  std::unique_ptr<TeachingPool> teachers;
  std::unique_ptr<Strands> strands;
  std::mutex ticking;
  std::condition_variable ticks;
  std::thread ticker;

  // HostedRoom::Host
  [[nodiscard]] std::int64_t now_us() const override { return clock(); }
  void post(std::int64_t room, Strands::Job job) override;
  void save(StoreBatch batch, std::function<void(bool)> done) override;
  void teach(TeachingPool::Urgency urgency, TeachingPool::Job job) override;
  [[nodiscard]] std::size_t num_runners_up(std::int64_t room) const override;
  void on_applied(HostedRoom& room, std::span<const RoomEvent> events) override;
  void on_trouble(std::int64_t room, const std::string& what) override;
  void on_waiting(HostedRoom& list) override;

  // service_waiting.cpp
  // Makes the waiting list if the study has one and it is not there yet.
  void make_waiting_list();
  // People of the waiting list have places in a new room, which is saved.
  void seat_group(const StoredRoom& stored, const std::vector<StoredEvent>& events);
  // Somebody's link leads to another seat from now on. The mutex is held.
  void move_person(const Place& from, const Place& to);
  // Where the holder of a link is now. The mutex is held.
  [[nodiscard]] Place place_of(const Identity& identity) const;
  [[nodiscard]] Place current_place(const Connection& connection) const;

  // service_rooms.cpp
  void load_rooms();
  // Keeps `seat_of_person` up to date. The mutex is held.
  void note_person(std::int64_t room, const std::string& actor, const std::string& type, const Json& body);
  // Has something that facilitators did written down in room 0, together with the rest of the batch.
  void record(StoreBatch batch, const std::string& actor, const std::string& type, const Json& body,
              const std::string& message, std::function<void(bool saved)> done);
  void record_next();
  // Makes rooms. On the service's strand. `made` gets their numbers, or a refusal.
  struct RoomsMade {
    std::vector<std::int64_t> rooms;
    std::optional<Refusal> refusal;
  };
  void make_rooms(const Json& body, const std::string& actor, const std::string& message,
                  std::function<void(const RoomsMade&)> made);
  [[nodiscard]] std::shared_ptr<HostedRoom> room_of(std::int64_t number) const;
  // All rooms but the waiting list. The mutex is held.
  [[nodiscard]] std::size_t num_groups() const;
  // Numbers a new room and its replicate. The mutex is held.
  void enrol(RoomSetup& setup);
  // By id or code; null if there is none.
  [[nodiscard]] std::shared_ptr<HostedRoom> room_named(const std::string& name) const;
  // A new link for a seat, once it is on the disk; empty if it cannot be saved.
  void make_link(std::int64_t room, std::int64_t seat, std::function<void(std::string token)> made);
  void write_log(LogEntry entry);

  // service_connections.cpp
  void hello(const std::shared_ptr<Connection>& connection, const Json& frame);
  void beat(const Connection& connection);
  void message(const std::shared_ptr<Connection>& connection, const std::string& type, const Json& frame);
  void tell_room(const std::shared_ptr<Connection>& connection, const std::string& type, const std::string& id,
                 const Json& body);
  void facilitate(const std::shared_ptr<Connection>& connection, const std::string& type, const std::string& id,
                  const Json& body);
  // Carries out a facilitator's message that is for no room: once, however often it is sent. On the service's strand.
  void carry_out(const std::string& id, Reply reply, const std::function<void(Reply)>& act);
  void select_room(const std::shared_ptr<Connection>& connection, const Json& body, const Reply& reply);
  void revoke_link(const std::string& id, const Json& body, const Reply& reply);
  void attend(const std::shared_ptr<Connection>& connection);
  void push_view(Connection& connection, Json view) const;
  void push_page(Connection& connection, const HostedRoom& hosted, std::size_t seat);
  void push_room(HostedRoom& hosted);
  void tell_presence(std::int64_t number, std::int64_t seat, const char* type);
  [[nodiscard]] std::shared_ptr<Connection> connection_of(ConnectionId id) const;

  // service_views.cpp
  // Shows something of a room to whoever looks. If that fails facilitators read why, and the room goes on.
  bool can_show(const HostedRoom& hosted, const std::string& what, const std::function<void()>& show);
  void take_picture(HostedRoom& hosted);
  // Has who understands what computed anew where facilitators look, or where somebody has many wrong answers; aside.
  void audit_next();
  void keep_audit(std::int64_t number, RoomAudit audit);
  void show_facilitators();
  // Shows them at the next tick what there is, and at the one after it the pictures that are taken meanwhile. @pre the
  // mutex is held.
  void await_news() {
    has_news = true;
    ticks_awaited = 2;
  }
  [[nodiscard]] Json facilitator_view(const Connection& connection) const;
  [[nodiscard]] Json integrity() const;

  // service_http.cpp
  [[nodiscard]] HttpReply handle(const HttpRequest& request);
  [[nodiscard]] HttpReply join(const HttpRequest& request);
  [[nodiscard]] HttpReply world(const std::string& key);
  [[nodiscard]] HttpReply export_tables(const std::string& query);

  void tick();
  void check_presence(std::int64_t now);
  void check_space(std::int64_t now);
};

// What tells a person apart from all others: the value of the first parameter that the study collects; empty if it is
// not there.
[[nodiscard]] std::string person_of(const LiveStudy& study, const Json& query);

// Whether facilitators read of an event in their log: what they did, and who came and went.
[[nodiscard]] bool is_logged(std::string_view actor, std::string_view type);
// @param room  0: of the service.
[[nodiscard]] LogEntry log_entry(std::int64_t room, std::int64_t at_us, const std::string& actor,
                                 const std::string& type, const Json& body);

// Frames of the protocol.
[[nodiscard]] Json ack_frame(const std::string& id);
[[nodiscard]] Json nak_frame(const std::string& id, const Refusal& refusal);

// "r12" for room 12, and back; 0 for anything else.
[[nodiscard]] std::string room_id(std::int64_t number);
[[nodiscard]] std::int64_t room_number(const std::string& id);
// The seat that somebody had on the waiting list, of the body of an event "seated".
[[nodiscard]] Place origin_of(const Json& body);

inline constexpr std::int64_t kSecond = 1'000'000;  // in microseconds
inline constexpr std::size_t kLongestId = 64;
// Free space below which people are warned, and below which nobody new is let in.
inline constexpr std::uint64_t kLittleSpace = 200'000'000;
inline constexpr std::uint64_t kNoSpace = 50'000'000;

}  // namespace kith
