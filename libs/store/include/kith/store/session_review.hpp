#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kith/live/room.hpp"
#include "kith/store/event_file.hpp"

namespace kith {

/// A room in a list.
struct RoomSummary {
  std::int64_t number = 0;
  std::string id;
  std::string strategy;
  std::string composition;
  std::int64_t created_us = 0;
  std::int64_t last_us = 0;  ///< Of the last event; 0 without events.
  std::uint64_t events = 0;
  std::size_t joined = 0;   ///< People who took a seat.
  std::size_t gone = 0;     ///< Of them, who left, dropped out or were replaced before the end.
  std::size_t lessons = 0;  ///< Taught, the one under way included.
  std::size_t answers = 0;
  bool has_started = false;
  bool is_taught = false;  ///< Whether nothing is left to teach.
  std::string ended{};     ///< Why, if it ended before its time.
};

/// The rooms of a session, in order, from their events. Only rooms that have had all lessons that their study allows
/// are computed again, to see whether the last one is over. @throws those of restore_session_study().
[[nodiscard]] std::vector<RoomSummary> list_rooms(EventFile& file);

/// The room with this id ("r3") or code. @throws kith::Error (kInvalidInput, E1618) if there is none.
[[nodiscard]] StoredRoom find_room(EventFile& file, const std::string& name);

/// The result of replaying a room.
struct ReplayedRoom {
  std::int64_t number = 0;
  std::string id;
  std::uint64_t events = 0;
  std::size_t lessons = 0;
  std::string digest{};   ///< Of the room at the end; empty if it could not be replayed.
  std::string problem{};  ///< Why not, or what differs; empty if all is as it was.
};

/// The event as rooms take it. @throws kith::Error (kMismatch, E1612) if its text is no JSON.
[[nodiscard]] RoomEvent room_event_of(const StoredEvent& event);
/// Its members as they are stored. @throws the same.
[[nodiscard]] Json body_of(const StoredEvent& event);

/// Computes a room again from its setup and events, and compares every lesson with what was taught then.
/// @param on_event  is told every event after it was applied; may be empty.
[[nodiscard]] ReplayedRoom replay_room(EventFile& file, const StoredRoom& stored,
                                       const std::shared_ptr<const LiveStudy>& study, TeachingCache& cache,
                                       const std::function<void(const Room&, const RoomEvent&)>& on_event = {});

/// Erases what identifies people: names, free text of questions, query parameters. Everything else stays, ids too, so
/// the session replays as before. The erasure is an event of its own.
/// @param room  one room; otherwise all, and also the query parameters of people who found no seat. @return the number
/// of events that were changed.
/// @throws kith::Error kBusy E1610 if the session is being served; kIo.
std::size_t redact(const std::filesystem::path& folder, std::optional<std::string> room, std::int64_t now_us);

/// Who somebody is, as the recruitment platform says: the first of `collect_query`; empty if it does not.
[[nodiscard]] std::string platform_id(const LiveStudy& study, const Json& query);

/// A seat of a room, by number.
using StoredSeat = std::pair<std::int64_t, std::size_t>;

/// Withdraws one person: what they entered, said and did goes for good, with all times, and their links become void. Of
/// answers only what the lessons of the others rest on is left, the counts of the path, so the room replays as before.
/// Exports and audits leave the person out from then on, and say that somebody was withdrawn. They are also erased on
/// the waiting list, in other seats that they had, see platform_id(), and where they were turned away.
/// @param room  id or code.  @param seat  from 1.
/// @param is_trial  nothing is changed.
/// @return how many events of each type are changed.
/// @throws kith::Error as redact(); kInvalidInput E1618 (no such room), E1624 (no such person); kMismatch E1614 (the
/// room would not replay)
std::map<std::string, std::size_t> withdraw(const std::filesystem::path& folder, const std::string& room,
                                            std::size_t seat, std::int64_t now_us, bool is_trial = false);

/// Everybody who was withdrawn.
[[nodiscard]] std::set<StoredSeat> withdrawn_seats(EventFile& file);

/// What a salvage found.
struct SalvageReport {
  std::size_t rooms = 0;
  std::size_t events = 0;  ///< In the new file.
  std::size_t links = 0;
  std::vector<std::string> lost{};  ///< In words: which events are missing, and what had to be left out after them.
};

/// Copies every intact row that SQLite still reads of a damaged session to a new one in another folder. Of each room
/// the events up to the first missing one are kept, since what follows cannot be understood without it.
/// @throws kith::Error kInvalidInput E1616 (the folder holds no session), kMismatch E1619 (nothing can be recovered:
/// the identity of the session is lost, or SQLite reads no row), kUsage E1620 (the new folder is not empty); kIo.
[[nodiscard]] SalvageReport salvage_session(const std::filesystem::path& folder, const std::filesystem::path& target);

}  // namespace kith
