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

#include "kith/live/message.hpp"

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
/// the session, from 0; without `seat` it is about that of the actor. `kMembers` are the members as stores have them,
/// in order; those with limits are also read from the command that asks for the event.
namespace happening {

inline constexpr std::size_t kMostNameBytes = 80;
inline constexpr std::string_view kNoType = "The study has no learner type of this letter.";

/// Numbers of tests, of actions in a path, of answers on a board.
inline constexpr Limits kFew{.most = 1000};
inline constexpr Limits kTime{.most = 86'400'000};
inline constexpr Limits kVersion{.longest = 100};
inline constexpr Limits kMayMiss{.may_miss = true};
/// Which round the page showed: what was meant for one that is over does not count for another.
inline constexpr Limits kRound{.is_stored = false};
inline constexpr Limits kPlace{.least = 1, .reason = "no-seat", .text = "There is no such place in this group."};
inline constexpr Limits kPlanned{.reason = "not-now",
                                 .text = "Somebody has come or gone since this group was planned."};
inline constexpr Limits kReason{
    .longest = 500, .reason = "no-reason", .text = "State a reason; it is kept with the data."};

[[nodiscard]] bool is_object(const Json& json);
/// A state of a world as pages have it, not yet whether there is such a state.
[[nodiscard]] bool is_frame(const Json& json);
/// What was pressed and when, [[action | "undo" | "reset", ms], ...].
[[nodiscard]] bool are_keys(const Json& json);

inline constexpr auto kSeat = RoomSender::kSeat;
inline constexpr auto kFacilitator = RoomSender::kFacilitator;
inline constexpr auto kServer = RoomSender::kServer;
inline constexpr bool kLogged = true, kUnlogged = false;
inline constexpr PersonalMember kItsQuery{"query", PersonalMember::What::kQuery};
inline constexpr PersonalMember kItsName{"name", PersonalMember::What::kNameIfAny};
inline constexpr PersonalMember kNewName{"name", PersonalMember::What::kName};
inline constexpr PersonalMember kItsWords{"text", PersonalMember::What::kWords};
inline constexpr PersonalMember kItsAnswers{"answers", PersonalMember::What::kAnswers};

/// Somebody took a free seat; on a waiting list there are no members.
struct Joined {
  static constexpr RoomEventKind kKind{"joined", "join", kServer, kLogged};
  std::size_t seat = 0;
  std::optional<std::size_t> member{};
  static constexpr auto kMembers =
      members("seat", &Joined::seat,
              Limits{.least = 1, .most = 1000, .may_miss = true, .text = "'seat' is not a number of a seat"}, "member",
              &Joined::member);
};

/// Somebody agreed to that version of the text; what does not `accept` it is Declined.
struct Consented {
  static constexpr RoomEventKind kKind{"consented", "consent", kSeat, kUnlogged, false, false, {kItsQuery}};
  std::string version;
  Json query;
  bool accept = true;
  static constexpr auto kMembers =
      members("accept", &Consented::accept, Limits{.is_stored = false}, "version", &Consented::version, kVersion,
              "query", &Consented::query, Limits{.may_miss = true, .type = "Record<string, string>"});
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
  static constexpr RoomEventKind kKind{"named", "name", kSeat, kUnlogged, false, true, {kNewName}};
  std::string name;
  static constexpr auto kMembers =
      members("name", &Named::name, Limits{.longest = kMostNameBytes, .is_one_line = true});
};

/// An answer to a test of the screening; it may never end.
struct Screened {
  static constexpr RoomEventKind kKind{"screened", "screen", kSeat};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  bool right = false;
  std::int64_t ms = 0;
  bool for_ever = false;
  static constexpr auto kMembers =
      members("test", &Screened::test, kFew, "actions", &Screened::actions, kFew, "right", &Screened::right, "ms",
              &Screened::ms, kTime, "for_ever?", &Screened::for_ever, Limits{});
};

/// An answer to board `test` of the exam, from `start` (a StartIndex); it may never end. `erased` as in Answered.
struct Examined {
  static constexpr RoomEventKind kKind{"examined", "examine", kSeat, kUnlogged, false};
  std::size_t test = 0, start = 0;
  std::vector<std::size_t> actions;
  bool right = false;
  std::int64_t ms = 0;
  bool for_ever = false;
  Json erased{};
  static constexpr auto kMembers =
      members("test", &Examined::test, kFew, "start", &Examined::start, "actions", &Examined::actions, kFew, "right",
              &Examined::right, "ms", &Examined::ms, kTime, "for_ever?", &Examined::for_ever, Limits{}, "erased?",
              &Examined::erased);
};

/// The lessons begin, by "server" or "facilitator"; whether stand-ins fill the places that are free.
struct Started {
  static constexpr RoomEventKind kKind{"started", "start", kFacilitator, kLogged};
  std::string by;
  bool fill = false;
  std::optional<std::string> reason{};
  static constexpr auto kMembers =
      members("by", &Started::by, "fill", &Started::fill, "reason?", &Started::reason, kReason);
};

/// The teacher chose the next lesson, or has no further one.
struct LessonChosen {
  static constexpr RoomEventKind kKind{"lesson", "", kServer};
  std::string key, digest;
  std::size_t period = 0;
  bool finished = false;
  static constexpr auto kMembers = members("key", &LessonChosen::key, "digest", &LessonChosen::digest, "period",
                                           &LessonChosen::period, "finished", &LessonChosen::finished);
};

/// Somebody watched a demonstration.
struct Watched {
  static constexpr RoomEventKind kKind{"watched", "watched", kSeat};
  std::size_t index = 0;
  std::optional<std::size_t> round{};
  static constexpr auto kMembers = members("demo", &Watched::index, kFew, "round?", &Watched::round, kRound);
};

/// What somebody has of a path so far.
struct Drafted {
  static constexpr RoomEventKind kKind{"draft", "draft", kSeat, kUnlogged, false};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  static constexpr auto kMembers = members("test", &Drafted::test, kFew, "actions", &Drafted::actions, kFew);
};

/// An answer to a test, with what was pressed and when; it may never end. `erased`, of somebody who was withdrawn, is
/// what is left of the path: {finished, counts}, what the lessons after it rest on.
struct Answered {
  static constexpr RoomEventKind kKind{"answered", "answer", kSeat};
  std::size_t test = 0;
  std::vector<std::size_t> actions;
  Json keys = Json::array();
  std::int64_t ms = 0;
  bool for_ever = false;
  Json erased{};
  std::optional<std::size_t> round{};
  static constexpr auto kMembers =
      members("test", &Answered::test, kFew, "actions", &Answered::actions, kFew, "keys", &Answered::keys,
              Limits{.may_miss = true, .fits = are_keys, .type = "KeyPress[]"}, "ms", &Answered::ms, kTime, "for_ever?",
              &Answered::for_ever, Limits{}, "erased?", &Answered::erased, "round?", &Answered::round, kRound);
};

/// Somebody has seen the answers of the group to a test and keeps the own one, or takes one of the board.
struct Discussed {
  static constexpr RoomEventKind kKind{"discussed", "discuss", kSeat};
  std::size_t test = 0;
  std::optional<std::size_t> choice{};
  std::int64_t ms = 0;
  std::optional<std::size_t> round{};
  static constexpr auto kMembers = members("test", &Discussed::test, kFew, "choice", &Discussed::choice, kFew, "ms",
                                           &Discussed::ms, kTime, "round?", &Discussed::round, kRound);
};

/// Somebody has seen the feedback.
struct Continued {
  static constexpr RoomEventKind kKind{"continued", "continue", kSeat};
  std::optional<std::size_t> round{};
  static constexpr auto kMembers = members("round?", &Continued::round, kRound);
};

/// Somebody asked where the robot would go from `start` (a frame as pages have it): in a world of the domain, or on a
/// map that they changed. Null: what somebody asked who was withdrawn.
struct Explored {
  static constexpr RoomEventKind kKind{"explored", "explore", kSeat, kUnlogged, false};
  Json start;
  std::optional<std::size_t> world;
  std::vector<std::string> map;
  static constexpr auto kMembers = members("start", &Explored::start, Limits{.fits = is_frame, .type = "Frame"},
                                           "world?", &Explored::world, Limits{}, "map?", &Explored::map, Limits{});
};

/// Answers to the questions at the end, by id.
struct QuestionsAnswered {
  static constexpr RoomEventKind kKind{"questions", "questions", kSeat, kUnlogged, false, true, {kItsAnswers}};
  Json answers;
  static constexpr auto kMembers = members("answers", &QuestionsAnswered::answers,
                                           Limits{.fits = is_object, .type = "Record<string, string | number>"});
};

/// Somebody leaves by their own choice; `by` takes the seat over, a stand-in if it has a type.
struct Left {
  static constexpr RoomEventKind kKind{"left", "leave", kSeat, kLogged};
  std::optional<std::size_t> by{};
  std::optional<std::string> type{};
  static constexpr auto kMembers = members("by", &Left::by, "type", &Left::type);
};

/// Somebody is not there.
struct Away {
  static constexpr RoomEventKind kKind{"away", "away", kServer, kLogged};
  std::size_t seat = 0;
  static constexpr auto kMembers = members("seat", &Away::seat, kPlace);
};

/// Somebody is there again.
struct Present {
  static constexpr RoomEventKind kKind{"present", "present", kServer, kLogged};
  std::size_t seat = 0;
  static constexpr auto kMembers = members("seat", &Present::seat, kPlace);
};

/// The grace period is over; as Left.
struct Dropped {
  static constexpr RoomEventKind kKind{"dropped", "", kServer, kLogged};
  std::size_t seat = 0;
  std::string policy;
  std::optional<std::size_t> by{};
  std::optional<std::string> type{};
  static constexpr auto kMembers =
      members("seat", &Dropped::seat, "policy", &Dropped::policy, "by", &Dropped::by, "type", &Dropped::type);
};

/// A seat in the lobby is free again.
struct Released {
  static constexpr RoomEventKind kKind{"released", "", kServer, kLogged};
  std::size_t seat = 0;
  std::string why;
  static constexpr auto kMembers = members("seat", &Released::seat, "why", &Released::why);
};

/// On a waiting list: people have a place in a new room; by member whether it is simulated, and the seat on the list.
struct Grouped {
  static constexpr RoomEventKind kKind{"grouped", "group", kServer, kLogged};
  std::string strategy, composition;
  std::vector<bool> simulated;
  std::vector<std::optional<std::size_t>> seats;
  std::string room;
  static constexpr auto kMembers =
      members("strategy", &Grouped::strategy, kPlanned, "composition", &Grouped::composition, kPlanned, "simulated",
              &Grouped::simulated, kPlanned, "seats", &Grouped::seats, kPlanned, "room", &Grouped::room,
              Limits{.longest = 100, .reason = "not-now", .text = "No group can be formed at the moment."});
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
  static constexpr auto kMembers =
      members("seat", &Seated::seat, "member", &Seated::member, kFew, "from", &Seated::from, Limits{.fits = is_object},
              "version", &Seated::version, kVersion, "query", &Seated::query, kMayMiss, "name", &Seated::name,
              Limits{.longest = kMostNameBytes}, "screened", &Seated::screened, Limits{}, "ready_us", &Seated::ready_us,
              Limits{});
};

/// A time limit is over: that of a phase, or of the session.
struct TimeOver {
  static constexpr RoomEventKind kKind{"time", "", kServer, kLogged};
  std::string what;
  static constexpr auto kMembers = members("what", &TimeOver::what);
};

/// Nothing goes on until it is resumed.
struct Paused {
  static constexpr RoomEventKind kKind{"pause", "pause", kFacilitator};
  std::string reason;
  static constexpr auto kMembers = members("reason", &Paused::reason, kReason);
};

/// Everything goes on.
struct Resumed {
  static constexpr RoomEventKind kKind{"resume", "resume", kFacilitator};
  std::string reason;
  static constexpr auto kMembers = members("reason", &Resumed::reason, kReason);
};

/// Time limits are later.
struct Extended {
  static constexpr RoomEventKind kKind{"extend", "extend", kFacilitator, kUnlogged, false};
  std::int64_t seconds = 0;
  std::string reason;
  static constexpr auto kMembers =
      members("seconds", &Extended::seconds,
              Limits{.least = 1, .most = 86'400, .text = "'seconds' must be a number from 1 to 86400."}, "reason",
              &Extended::reason, kReason);
};

/// To a seat, or to everybody.
struct MessageSent {
  static constexpr RoomEventKind kKind{"message", "message", kFacilitator, kUnlogged, false, true, {kItsWords}};
  std::string text;
  std::optional<std::size_t> seat{};
  std::string reason;
  static constexpr auto kMembers =
      members("text", &MessageSent::text, Limits{.longest = 2000, .text = "'text' is missing or too long."}, "seat",
              &MessageSent::seat, kPlace, "reason", &MessageSent::reason, kReason);
};

/// Somebody has their place again.
struct Readmitted {
  static constexpr RoomEventKind kKind{"readmit", "readmit", kFacilitator};
  std::size_t seat = 0;
  std::string reason;
  static constexpr auto kMembers = members("seat", &Readmitted::seat, kPlace, "reason", &Readmitted::reason, kReason);
};

/// A stand-in of that type, seat `by`, takes the place.
struct Simulated {
  static constexpr RoomEventKind kKind{"simulate", "simulate", kFacilitator};
  std::size_t seat = 0;
  std::string type;
  std::size_t by = 0;
  std::string reason;
  static constexpr auto kMembers =
      members("seat", &Simulated::seat, kPlace, "type", &Simulated::type,
              Limits{.shortest = 1, .longest = 1, .may_miss = true, .reason = "no-type", .text = kNoType}, "by",
              &Simulated::by, "reason", &Simulated::reason, kReason);
};

/// Another strategy from the next lesson on.
struct StrategyNamed {
  static constexpr RoomEventKind kKind{"strategy", "strategy", kFacilitator};
  std::string name, reason;
  static constexpr auto kMembers =
      members("name", &StrategyNamed::name, Limits{.longest = 200, .text = "'name' is missing."}, "reason",
              &StrategyNamed::reason, kReason);
};

/// The session ended before its time.
struct Ended {
  static constexpr RoomEventKind kKind{"ended", "end", kFacilitator, kLogged};
  std::string reason, text;
  static constexpr auto kMembers = members("reason", &Ended::reason, kReason, "text", &Ended::text);
};

/// Events are equal if all of their members are that are stored.
template <typename Event>
requires requires { Event::kKind; }
bool operator==(const Event& a, const Event& b) {
  const auto is_same = [&](const auto& member) { return !member.is_stored() || a.*member.at == b.*member.at; };
  return std::apply([&](const auto&... member) { return (is_same(member) && ...); }, Event::kMembers);
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
