#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "busy_count.hpp"
#include "directory.hpp"
#include "hosted_room.hpp"
#include "join_desk.hpp"
#include "kith/service/authorisation.hpp"
#include "kith/service/live_service.hpp"
#include "kith/store/event_store.hpp"
#include "room_maker.hpp"
#include "service_log.hpp"
#include "strands.hpp"
#include "teaching_pool.hpp"
#include "views.hpp"
#include "waiting_list.hpp"

namespace kith {

// The parts of a service. Each owns its data: a room on its own strand, views on theirs, and the directory, the desk at
// which people join, the maker of rooms and the log on that of the desk, since a join concerns them all. They tell each
// other by jobs, and nobody waits.
struct ServiceState {
  ServiceState(std::shared_ptr<const LiveStudy> live_study, LiveServiceOptions service_options);
  ~ServiceState() { stop(); }
  ServiceState(const ServiceState&) = delete;
  ServiceState& operator=(const ServiceState&) = delete;

  // What does not change, or can be used from any thread.
  std::shared_ptr<const LiveStudy> study;
  LiveServiceOptions options;
  BusyCount busy;
  EventStore store;
  std::string join_code;
  std::atomic<std::uint64_t> free_space;
  std::atomic<std::size_t> num_sessions = 0;
  std::atomic<LiveService::ConnectionId> last_connection = 0;
  std::atomic<bool> is_stopping = false;
  TeachingCaches caches;
  TeachingPool teachers;
  Strands strands;
  Strand desk = strands.make();
  Strand pages = strands.make();                         // worlds
  std::map<std::string, LiveService::HttpReply> worlds;  // on `pages`: everybody asks for the same few
  Strand exports = strands.make();                       // which take long

  // On the strand of the desk.
  ServiceLog log{*this};
  Directory directory{*this};
  RoomMaker maker{*this};
  JoinDesk joins{*this};
  std::int64_t looked_at_space_us = 0;
  asio::steady_timer timer{desk};

  // On others.
  WaitingList waiting{*this};
  Views views{*this};

  [[nodiscard]] std::int64_t now_us() const { return options.now_us(); }
  [[nodiscard]] std::int64_t links_expire_us() const;
  // On the strand of the desk.
  void post(Strands::Job job) { strands.post(desk, std::move(job)); }
  void save(StoreBatch batch, std::function<void(bool saved)> done);
  // Events were saved and applied: on the strand of the room.
  void on_applied(HostedRoom& room, std::span<const RoomEvent> events);

  void load();
  void tick();
  void keep_ticking();
  void check_space(std::int64_t now);
  void stop();

  // Requests; from any thread.
  void handle(const LiveService::HttpRequest& request, const HttpAnswer& answer);
  // Does it on a strand; if it fails, that is the answer.
  void answer_on(const Strand& strand, const HttpAnswer& answer, std::function<void()> job);
  void serve(const std::string& route, const LiveService::HttpRequest& request, const HttpAnswer& answer);
};

[[nodiscard]] LiveService::HttpReply json_reply(int status, const Json& body);
[[nodiscard]] LiveService::HttpReply error_reply(int status, const std::string& reason, const std::string& text);
[[nodiscard]] inline Refusal not_saved() { return {"not-saved", "This could not be saved; try again."}; }
[[nodiscard]] inline Refusal no_room() { return {"no-room", "There is no such room."}; }

// The seat that somebody had on the waiting list, of the body of an event "seated".
[[nodiscard]] Place origin_of(const Json& body);

inline constexpr std::int64_t kSecond = 1'000'000;  // in microseconds
// Free space below which people are warned, and below which nobody new is let in.
inline constexpr std::uint64_t kLittleSpace = 200'000'000;
inline constexpr std::uint64_t kNoSpace = 50'000'000;

}  // namespace kith
