#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/present/json.hpp"

namespace kith {

/// Something that happened in a room. The events of a room, in order, are all that there is to know about it.
///
/// Types, with what their bodies hold (`seat` is a number of a person or stand-in, from 1):
///   joined {seat, member|null}                 somebody took a free seat, or waits in reserve
///   consented {version, query}, declined {}    seat; whoever declines is gone, and the seat is free again
///   checked {}, named {name}                   seat
///   screened {test, actions, right, ms}        seat; like an answer with for_ever (true) if the path never ends
///   started {by}                               server or facilitator
///   lesson {key, digest, period, finished}     server: the teacher chose the next lesson, or has no further one
///   watched {demo}, draft {test, actions}      seat
///   answered {test, actions, keys, ms}         seat; with for_ever (true) if the path never ends
///   continued {}, questions {answers}          seat
///   left {}                                    seat, by their own choice
///   away {seat}, present {seat}                server
///   dropped {seat, policy, by|null, type|null} server: the grace period is over; `by` is who takes the seat
///   released {seat, why}                       server: a seat in the lobby is free again
///   grouped {room, strategy, composition,      server, on a waiting list: people have a place in a new room; per
///            simulated, seats}                 member whether it is simulated, and the seat on the list or null
///   called {seat, room, for, type, why}        server, on a waiting list: the person takes over seat `for` of a room
///                                              whose group has begun; `type` is that of the place, `why` left or away
///   seated {seat, member|null, from, version,  server: somebody from the waiting list has the place, or, without a
///           query, name, screened, ready_us}   member, takes over that of the departure that follows; `from` is
///                                              {room, seat} there, the rest what the room has to know of them
///   time {what}                                server: a time limit is over: watch, predict, feedback, session
///   pause, resume {reason}                     facilitator
///   extend {seconds, reason}, message {text, seat|null, reason}, readmit {seat, reason},
///   simulate {seat, type, by, reason}, strategy {name, reason}                           facilitator
///   ended {reason, text}                       server or facilitator: the session ended before its time
struct RoomEvent {
  std::uint64_t seq = 0;   ///< From 1, without gaps within a room.
  std::int64_t at_us = 0;  ///< Microseconds since 1970 on the server's clock; never decreases within a room.
  std::string actor;       ///< "seat:1", "facilitator" or "server".
  std::string type;
  Json body;
  friend bool operator==(const RoomEvent&, const RoomEvent&) = default;
};

/// What somebody asks for. Types of seats and facilitators are those of docs/live-protocol.md; those of the server:
///   join {seat?}           takes a free seat: that one, or any; the event tells which
///   group {room, ...}      on a waiting list: what Room::next_group() plans is done; the body is that of the event
///   call {seat, ...}       on a waiting list: the person whom Room::next_for() names is called; the body is that of
///                          the event
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

/// {"seq", "at_us", "actor", "type", "body"} and back. @throws kith::Error (kInvalidInput) if a member is missing or of
/// the wrong type.
[[nodiscard]] Json to_json(const RoomEvent& event);
[[nodiscard]] RoomEvent room_event(const Json& json);

}  // namespace kith
