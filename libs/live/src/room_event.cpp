#include "kith/live/room_event.hpp"

#include <algorithm>
#include <charconv>

#include "kith/core/error.hpp"
#include "message_json.hpp"

namespace kith {

namespace happening {

bool is_object(const Json& json) { return json.is_object(); }

bool is_frame(const Json& json) {
  constexpr std::size_t kMostBytes = 2000;
  return json.is_object() && json.dump().size() <= kMostBytes;
}

bool are_keys(const Json& json) {
  constexpr std::size_t kMostKeys = 2000;
  const auto is_key = [](const Json& key) {
    if (!key.is_array() || key.size() != 2 || !read_within<std::int64_t>(key[1], kTime)) return false;
    return read_within<std::int64_t>(key[0], kFew) || key[0] == "undo" || key[0] == "reset";
  };
  return json.is_array() && json.size() <= kMostKeys && std::all_of(json.begin(), json.end(), is_key);
}

}  // namespace happening

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

Json body_of(const RoomEvent& event) {
  Json body = std::visit([](const auto& what) { return written(what); }, event.what);
  // What a facilitator gives as the reason comes last.
  const auto reason = body.find("reason");
  if (event.actor == "facilitator" && reason != body.end()) {
    auto text = *reason;
    body.erase("reason");
    body["reason"] = std::move(text);
  }
  return body;
}

RoomEvent room_event(std::uint64_t seq, std::int64_t at_us, std::string actor, std::string_view type,
                     const Json& body) {
  const auto wrong = [&](const std::string& why) {
    return Error{ErrorKind::kMismatch,
                 "event " + std::to_string(seq) + " ('" + std::string{type} + "') cannot be read: " + why};
  };
  if (!body.is_object()) throw wrong("its body is not an object");
  RoomEvent event{seq, at_us, std::move(actor), {}};
  std::size_t known = 0;
  const auto take = [&](const auto& member, auto& value) {
    if (!member.is_stored()) return;
    const auto found = body.find(std::string{member.name});
    if (found == body.end() && member.may_miss) return;
    if (found == body.end() || !read(*found, value)) throw wrong("it has no valid '" + std::string{member.name} + "'");
    ++known;
  };
  const bool is_known = [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    const auto is = [&]<typename Event>(std::in_place_type_t<Event> kind) {
      if (Event::kKind.word != type) return false;
      for_each_member(event.what.emplace<Event>(), take);
      static_cast<void>(kind);
      return true;
    };
    return (is(std::in_place_type<std::variant_alternative_t<kIndex, RoomHappening>>) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
  if (!is_known) throw wrong("there is no such event of a room");
  if (known != body.size()) throw wrong("it has an unknown member");
  return event;
}

}  // namespace kith
