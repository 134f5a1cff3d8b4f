#include "kith/live/room_event.hpp"

#include <charconv>

#include "kith/core/error.hpp"

namespace kith {

namespace {

// A value of a member; false if it is of another type.
bool read(const Json& json, Json& value) {
  value = json;
  return true;
}
bool read(const Json& json, std::string& value) {
  if (json.is_string()) value = json.get<std::string>();
  return json.is_string();
}
bool read(const Json& json, bool& value) {
  if (json.is_boolean()) value = json.get<bool>();
  return json.is_boolean();
}
bool read(const Json& json, std::int64_t& value) {
  if (json.is_number_integer()) value = json.get<std::int64_t>();
  return json.is_number_integer();
}
bool read(const Json& json, std::size_t& value) {
  std::int64_t number = -1;
  if (!read(json, number) || number < 0) return false;
  value = static_cast<std::size_t>(number);
  return true;
}
template <typename T>
bool read(const Json& json, std::optional<T>& value) {
  value.reset();
  return json.is_null() || read(json, value.emplace());
}
template <typename T>
bool read(const Json& json, std::vector<T>& values) {
  if (!json.is_array()) return false;
  for (const auto& element : json) {
    T value{};
    if (!read(element, value)) return false;
    values.push_back(std::move(value));
  }
  return true;
}

template <typename T>
Json written(const T& value) {
  return value;
}
template <typename T>
Json written(const std::optional<T>& value) {
  return value ? Json(*value) : Json{};
}
Json written(const std::vector<std::optional<std::size_t>>& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(written(value));
  return list;
}

}  // namespace

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
  Json body = Json::object();
  const auto add = [&](std::string_view name, const auto& member) {
    const bool may_miss = name.back() == '?';
    if (may_miss && member == std::remove_cvref_t<decltype(member)>{}) return;
    if (may_miss) name.remove_suffix(1);
    body[std::string{name}] = written(member);
  };
  std::visit([&](const auto& what) { happening::for_each_member(what, add); }, event.what);
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
  const auto take = [&](std::string_view name, auto& member) {
    const bool may_miss = name.back() == '?';
    if (may_miss) name.remove_suffix(1);
    const auto found = body.find(std::string{name});
    if (found == body.end() && may_miss) return;
    if (found == body.end() || !read(*found, member)) throw wrong("it has no valid '" + std::string{name} + "'");
    ++known;
  };
  const bool is_known = [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    const auto is = [&]<typename Event>(std::in_place_type_t<Event> kind) {
      if (Event::kKind.word != type) return false;
      happening::for_each_member(event.what.emplace<Event>(), take);
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
