#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "kith/explain/json.hpp"

namespace kith {

/// Whose command leads to an event, unless the clock or the teacher does.
enum class RoomSender { kSeat, kFacilitator, kServer };

/// What a member of an event may say of somebody, which can be erased.
struct PersonalMember {
  enum class What {
    kName,       ///< What somebody wants to be called.
    kNameIfAny,  ///< The same; empty: they said nothing.
    kQuery,      ///< What a recruitment platform said of the person.
    kWords,      ///< Somebody's own words.
    kAnswers,    ///< Answers to questions by id, some of them in own words.
  };
  std::string_view name{};  ///< Empty: there is no such member.
  What what = What::kName;
};

/// What holds of all events of a kind: one row per kind.
struct RoomEventKind {
  std::string_view word;        ///< In stores, exports and the log: "answered".
  std::string_view command;     ///< What is asked for: "answer"; empty: the clock or the teacher demands it.
  RoomSender sender;            ///< Who may ask.
  bool is_logged = false;       ///< In the log, as all that facilitators do.
  bool changes_lessons = true;  ///< Whether other lessons may be likely after it.
  bool is_free_text = false;    ///< Whether it is what people typed, so that parts may have been erased.
  std::array<PersonalMember, 2> personal{};
};

/// Everything that can happen in a room. `seat` is a number of a person or stand-in, from 1, and `member` of a place of
/// the session, from 0; without `seat` it is about that of the actor. `kMembers` are the names of the members in
/// stores, in order; with '?' one that is left out unless it is set.
namespace happening {

inline constexpr auto kSeat = RoomSender::kSeat;
inline constexpr auto kFacilitator = RoomSender::kFacilitator;
inline constexpr auto kServer = RoomSender::kServer;
inline constexpr bool kLogged = true, kUnlogged = false;
inline constexpr PersonalMember kItsQuery{"query", PersonalMember::What::kQuery};
inline constexpr PersonalMember kItsName{"name", PersonalMember::What::kNameIfAny};

/// Somebody took a free seat; on a waiting list there are no members.
struct Joined {
  static constexpr RoomEventKind kKind{"joined", "join", kServer, kLogged};
  std::size_t seat = 0;
  std::optional<std::size_t> member{};
  static constexpr std::tuple kMembers{"seat", &Joined::seat, "member", &Joined::member};
};

/// Somebody agreed to that version of the text.
struct Consented {
  static constexpr RoomEventKind kKind{"consented", "consent", kSeat, kUnlogged, false, false, {kItsQuery}};
  std::string version;
  Json query;
  static constexpr std::tuple kMembers{"version", &Consented::version, "query", &Consented::query};
};

/// Whoever declines is gone, and the seat is free again.
struct Declined {
  static constexpr RoomEventKind kKind{"declined", "consent", kSeat, kLogged};
  static constexpr std::tuple<> kMembers{};
};

/// Somebody has found out how the page works.
struct Checked {
  static constexpr RoomEventKind kKind{"checked", "checked", kSeat, kUnlogged, false};
  static constexpr std::tuple<> kMembers{};
};

/// What somebody wants to be called.
struct Named {
  static constexpr RoomEventKind kKind{
      "named", "name", kSeat, kUnlogged, false, true, {PersonalMember{"name", PersonalMember::What::kName}}};
  std::string name;
  static constexpr std::tuple kMembers{"name", &Named::name};
};

/// An answer to a test of the screening; it may never end.
struct Screened {
  static constexpr RoomEventKind kKind{"screened", "screen", kSeat};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  bool right = false;
  std::int64_t ms = 0;
  bool for_ever = false;
  static constexpr std::tuple kMembers{"test",      &Screened::test,    "actions", &Screened::actions,
                                       "right",     &Screened::right,   "ms",      &Screened::ms,
                                       "for_ever?", &Screened::for_ever};
};

/// An answer to board `test` of the exam, which begins in `start` (a StartIndex); it may never end.
struct Examined {
  static constexpr RoomEventKind kKind{"examined", "examine", kSeat, kUnlogged, false};
  std::size_t test = 0, start = 0;
  std::vector<std::size_t> actions;
  bool right = false;
  std::int64_t ms = 0;
  bool for_ever = false;
  static constexpr std::tuple kMembers{"test",    &Examined::test,    "start",     &Examined::start,
                                       "actions", &Examined::actions, "right",     &Examined::right,
                                       "ms",      &Examined::ms,      "for_ever?", &Examined::for_ever};
};

/// The lessons begin, by "server" or "facilitator"; whether stand-ins fill the places that are free.
struct Started {
  static constexpr RoomEventKind kKind{"started", "start", kFacilitator, kLogged};
  std::string by;
  bool fill = false;
  std::optional<std::string> reason{};
  static constexpr std::tuple kMembers{"by", &Started::by, "fill", &Started::fill, "reason?", &Started::reason};
};

/// The teacher chose the next lesson, or has no further one.
struct LessonChosen {
  static constexpr RoomEventKind kKind{"lesson", "", kServer};
  std::string key, digest;
  std::size_t period = 0;
  bool finished = false;
  static constexpr std::tuple kMembers{"key",    &LessonChosen::key,    "digest",   &LessonChosen::digest,
                                       "period", &LessonChosen::period, "finished", &LessonChosen::finished};
};

/// Somebody watched a demonstration.
struct Watched {
  static constexpr RoomEventKind kKind{"watched", "watched", kSeat};
  std::size_t demo = 0;
  static constexpr std::tuple kMembers{"demo", &Watched::demo};
};

/// What somebody has of a path so far.
struct Drafted {
  static constexpr RoomEventKind kKind{"draft", "draft", kSeat, kUnlogged, false};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  static constexpr std::tuple kMembers{"test", &Drafted::test, "actions", &Drafted::actions};
};

/// An answer to a test, with what was pressed and when; it may never end. `erased`, of somebody who was withdrawn, is
/// what is left of the path: {finished, counts}, what the lessons after it rest on.
struct Answered {
  static constexpr RoomEventKind kKind{"answered", "answer", kSeat};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  Json keys;
  std::int64_t ms = 0;
  bool for_ever = false;
  Json erased{};
  static constexpr std::tuple kMembers{"test",      &Answered::test,     "actions", &Answered::actions,
                                       "keys",      &Answered::keys,     "ms",      &Answered::ms,
                                       "for_ever?", &Answered::for_ever, "erased?", &Answered::erased};
};

/// Somebody has seen the answers of the group to a test and keeps the own one, or takes one of the board.
struct Discussed {
  static constexpr RoomEventKind kKind{"discussed", "discuss", kSeat};
  std::size_t test = 0;
  std::optional<std::size_t> choice{};
  std::int64_t ms = 0;
  static constexpr std::tuple kMembers{"test", &Discussed::test, "choice", &Discussed::choice, "ms", &Discussed::ms};
};

/// Somebody has seen the feedback.
struct Continued {
  static constexpr RoomEventKind kKind{"continued", "continue", kSeat};
  static constexpr std::tuple<> kMembers{};
};

/// Somebody asked where the robot would go from `start` (a frame as pages have it): in a world of the domain, or on a
/// map that they changed. Null: what somebody asked who was withdrawn.
struct Explored {
  static constexpr RoomEventKind kKind{"explored", "explore", kSeat, kUnlogged, false};
  Json start;
  std::optional<std::size_t> world;
  std::vector<std::string> map;
  static constexpr std::tuple kMembers{"start", &Explored::start, "world?", &Explored::world, "map?", &Explored::map};
};

/// Answers to the questions at the end, by id.
struct QuestionsAnswered {
  static constexpr RoomEventKind kKind{"questions",
                                       "questions",
                                       kSeat,
                                       kUnlogged,
                                       false,
                                       true,
                                       {PersonalMember{"answers", PersonalMember::What::kAnswers}}};
  Json answers;
  static constexpr std::tuple kMembers{"answers", &QuestionsAnswered::answers};
};

/// Somebody leaves by their own choice; `by` takes the seat over, a stand-in if it has a type.
struct Left {
  static constexpr RoomEventKind kKind{"left", "leave", kSeat, kLogged};
  std::optional<std::size_t> by{};
  std::optional<std::string> type{};
  static constexpr std::tuple kMembers{"by", &Left::by, "type", &Left::type};
};

/// Somebody is not there.
struct Away {
  static constexpr RoomEventKind kKind{"away", "away", kServer, kLogged};
  std::size_t seat = 0;
  static constexpr std::tuple kMembers{"seat", &Away::seat};
};

/// Somebody is there again.
struct Present {
  static constexpr RoomEventKind kKind{"present", "present", kServer, kLogged};
  std::size_t seat = 0;
  static constexpr std::tuple kMembers{"seat", &Present::seat};
};

/// The grace period is over; as Left.
struct Dropped {
  static constexpr RoomEventKind kKind{"dropped", "", kServer, kLogged};
  std::size_t seat = 0;
  std::string policy;
  std::optional<std::size_t> by{};
  std::optional<std::string> type{};
  static constexpr std::tuple kMembers{"seat", &Dropped::seat, "policy", &Dropped::policy,
                                       "by",   &Dropped::by,   "type",   &Dropped::type};
};

/// A seat in the lobby is free again.
struct Released {
  static constexpr RoomEventKind kKind{"released", "", kServer, kLogged};
  std::size_t seat = 0;
  std::string why;
  static constexpr std::tuple kMembers{"seat", &Released::seat, "why", &Released::why};
};

/// On a waiting list: people have a place in a new room; by member whether it is simulated, and the seat on the list.
struct Grouped {
  static constexpr RoomEventKind kKind{"grouped", "group", kServer, kLogged};
  std::string strategy, composition;
  std::vector<bool> simulated;
  std::vector<std::optional<std::size_t>> seats;
  std::string room;
  static constexpr std::tuple kMembers{"strategy",  &Grouped::strategy,  "composition", &Grouped::composition,
                                       "simulated", &Grouped::simulated, "seats",       &Grouped::seats,
                                       "room",      &Grouped::room};
};

/// Somebody from the waiting list has the place. `from` is {room, seat} there, the rest what the room has to know of
/// them.
struct Seated {
  static constexpr RoomEventKind kKind{"seated", "seat", kServer, kUnlogged, true, false, {kItsQuery, kItsName}};
  std::size_t seat = 0;
  std::size_t member = 0;
  Json from;
  std::string version;
  Json query;
  std::string name;
  std::vector<bool> screened;
  std::int64_t ready_us = 0;
  static constexpr std::tuple kMembers{
      "seat",  &Seated::seat,  "member", &Seated::member, "from",     &Seated::from,     "version",  &Seated::version,
      "query", &Seated::query, "name",   &Seated::name,   "screened", &Seated::screened, "ready_us", &Seated::ready_us};
};

/// A time limit is over: that of a phase, or of the session.
struct TimeOver {
  static constexpr RoomEventKind kKind{"time", "", kServer, kLogged};
  std::string what;
  static constexpr std::tuple kMembers{"what", &TimeOver::what};
};

/// Nothing goes on until it is resumed.
struct Paused {
  static constexpr RoomEventKind kKind{"pause", "pause", kFacilitator};
  std::string reason;
  static constexpr std::tuple kMembers{"reason", &Paused::reason};
};

/// Everything goes on.
struct Resumed {
  static constexpr RoomEventKind kKind{"resume", "resume", kFacilitator};
  std::string reason;
  static constexpr std::tuple kMembers{"reason", &Resumed::reason};
};

/// Time limits are later.
struct Extended {
  static constexpr RoomEventKind kKind{"extend", "extend", kFacilitator, kUnlogged, false};
  std::int64_t seconds = 0;
  std::string reason;
  static constexpr std::tuple kMembers{"seconds", &Extended::seconds, "reason", &Extended::reason};
};

/// To a seat, or to everybody.
struct MessageSent {
  static constexpr RoomEventKind kKind{"message",
                                       "message",
                                       kFacilitator,
                                       kUnlogged,
                                       false,
                                       true,
                                       {PersonalMember{"text", PersonalMember::What::kWords}}};
  std::string text;
  std::optional<std::size_t> seat{};
  std::string reason;
  static constexpr std::tuple kMembers{"text",   &MessageSent::text,  "seat", &MessageSent::seat,
                                       "reason", &MessageSent::reason};
};

/// Somebody has their place again.
struct Readmitted {
  static constexpr RoomEventKind kKind{"readmit", "readmit", kFacilitator};
  std::size_t seat = 0;
  std::string reason;
  static constexpr std::tuple kMembers{"seat", &Readmitted::seat, "reason", &Readmitted::reason};
};

/// A stand-in of that type, seat `by`, takes the place.
struct Simulated {
  static constexpr RoomEventKind kKind{"simulate", "simulate", kFacilitator};
  std::size_t seat = 0;
  std::string type;
  std::size_t by = 0;
  std::string reason;
  static constexpr std::tuple kMembers{"seat", &Simulated::seat, "type",   &Simulated::type,
                                       "by",   &Simulated::by,   "reason", &Simulated::reason};
};

/// Another strategy from the next lesson on.
struct StrategyNamed {
  static constexpr RoomEventKind kKind{"strategy", "strategy", kFacilitator};
  std::string name, reason;
  static constexpr std::tuple kMembers{"name", &StrategyNamed::name, "reason", &StrategyNamed::reason};
};

/// The session ended before its time.
struct Ended {
  static constexpr RoomEventKind kKind{"ended", "end", kFacilitator, kLogged};
  std::string reason, text;
  static constexpr std::tuple kMembers{"reason", &Ended::reason, "text", &Ended::text};
};

/// Calls visit(name, member) for every member of an event.
template <typename Event, typename Visit>
void for_each_member(Event& event, Visit visit) {
  using Members = std::remove_cvref_t<decltype(Event::kMembers)>;
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (visit(std::string_view{std::get<2 * kIndex>(Event::kMembers)}, event.*std::get<2 * kIndex + 1>(Event::kMembers)),
     ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Members> / 2>{});
}

/// Events are equal if all of their members are.
template <typename Event>
requires requires { Event::kKind; }
bool operator==(const Event& a, const Event& b) {
  using Members = std::remove_cvref_t<decltype(Event::kMembers)>;
  return [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    return ((a.*std::get<2 * kIndex + 1>(Event::kMembers) == b.*std::get<2 * kIndex + 1>(Event::kMembers)) && ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Members> / 2>{});
}

}  // namespace happening

using RoomHappening =
    std::variant<happening::Joined, happening::Consented, happening::Declined, happening::Checked, happening::Named,
                 happening::Screened, happening::Started, happening::LessonChosen, happening::Watched,
                 happening::Drafted, happening::Answered, happening::Continued, happening::Explored,
                 happening::QuestionsAnswered, happening::Left, happening::Away, happening::Present, happening::Dropped,
                 happening::Released, happening::Grouped, happening::Seated, happening::TimeOver, happening::Paused,
                 happening::Resumed, happening::Extended, happening::MessageSent, happening::Readmitted,
                 happening::Simulated, happening::StrategyNamed, happening::Ended, happening::Discussed,
                 happening::Examined>;

/// All rows.
inline constexpr auto kRoomEventKinds = []<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
  return std::array{std::variant_alternative_t<kIndex, RoomHappening>::kKind...};
}
(std::make_index_sequence<std::variant_size_v<RoomHappening>>{});

/// The row with this word; null if there is none.
[[nodiscard]] constexpr const RoomEventKind* room_event_kind(std::string_view word) {
  for (const auto& kind : kRoomEventKinds) {
    if (kind.word == word) return &kind;
  }
  return nullptr;
}

/// Something that happened in a room. The events of a room, in order, are all that there is to know about it.
struct RoomEvent {
  std::uint64_t seq = 0;   ///< From 1, without gaps within a room.
  std::int64_t at_us = 0;  ///< Microseconds since 1970 on the server's clock; never decreases within a room.
  std::string actor;       ///< "seat:1", "facilitator" or "server".
  RoomHappening what;

  [[nodiscard]] const RoomEventKind& kind() const { return kRoomEventKinds[what.index()]; }
  template <typename Event>
  [[nodiscard]] const Event* get() const noexcept {
    return std::get_if<Event>(&what);
  }
  friend bool operator==(const RoomEvent&, const RoomEvent&) = default;
};

/// What somebody asks for. Types of seats and facilitators are those of docs/live-protocol.md; those of the server:
///   join {seat?}           takes a free seat: that one, or any; the event tells which
///   group {room, ...}      on a waiting list: what Room::next_group() plans is done; the body is that of the event
///   seat {member, ...}     gives the place of a member to somebody from a waiting list, see Room::person_for()
///   away {seat}, present {seat}
struct RoomCommand {
  std::string actor;
  std::string type;
  Json body;
  std::string id;  ///< Chosen by who sends it; kept by the service, not by the room.
};

/// Why a command was not accepted.
struct Refusal {
  std::string reason;  ///< A stable word for programs: "bad-body", "not-now", "illegal-path", "too-late", "full", ...
  std::string text;    ///< Plain English.
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

/// What a command leads to: events, or a refusal. Neither: it was accepted before and changes nothing.
struct Decision {
  std::vector<RoomEvent> events;
  std::optional<Refusal> refusal;
};

/// "seat:3".
[[nodiscard]] std::string seat_actor(std::size_t seat);
/// 3 of "seat:3"; nothing of anything else.
[[nodiscard]] std::optional<std::size_t> seat_of_actor(std::string_view actor) noexcept;

/// The members of an event as stores and exports have them.
[[nodiscard]] Json body_of(const RoomEvent& event);
/// An event of a store. @throws kith::Error (kMismatch) if there is no such type, or a member is missing, unknown or of
/// the wrong type.
[[nodiscard]] RoomEvent room_event(std::uint64_t seq, std::int64_t at_us, std::string actor, std::string_view type,
                                   const Json& body);

}  // namespace kith
