#include "kith/live/room_event.hpp"

#include <charconv>

#include "kith/core/error.hpp"

namespace kith {

std::string seat_actor(std::size_t seat) { return "seat:" + std::to_string(seat); }

std::optional<std::size_t> seat_of_actor(std::string_view actor) noexcept {
  constexpr std::string_view kStart = "seat:";
  if (actor.substr(0, kStart.size()) != kStart) return std::nullopt;
  const auto digits = actor.substr(kStart.size());
  std::size_t seat = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), seat);
  if (digits.empty() || failure != std::errc{} || end != digits.data() + digits.size() || seat == 0)
    return std::nullopt;
  return seat;
}

Json to_json(const RoomEvent& event) {
  return {
      {"seq", event.seq}, {"at_us", event.at_us}, {"actor", event.actor}, {"type", event.type}, {"body", event.body}};
}

RoomEvent room_event(const Json& json) {
  const auto wrong = [](const char* what) {
    return Error{ErrorKind::kInvalidInput, std::string{"an event of a room has no valid '"} + what + "'"};
  };
  if (!json.is_object()) throw Error{ErrorKind::kInvalidInput, "an event of a room is not an object"};
  const auto member = [&](const char* name) -> const Json& {
    const auto found = json.find(name);
    if (found == json.end()) throw wrong(name);
    return *found;
  };
  const auto& seq = member("seq");
  const auto& at = member("at_us");
  const auto& actor = member("actor");
  const auto& type = member("type");
  const auto& body = member("body");
  if (!seq.is_number_unsigned()) throw wrong("seq");
  if (!at.is_number_integer()) throw wrong("at_us");
  if (!actor.is_string()) throw wrong("actor");
  if (!type.is_string()) throw wrong("type");
  if (!body.is_object()) throw wrong("body");
  return {seq.get<std::uint64_t>(), at.get<std::int64_t>(), actor.get<std::string>(), type.get<std::string>(), body};
}

}  // namespace kith
