#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "kith/live/room_event.hpp"
#include "message_json.hpp"
#include "room_state.hpp"

namespace kith {

// Commands come from anybody: what asks for an event is read through the members that the event declares.

[[nodiscard]] inline Decision refused(std::string reason, std::string text) {
  return {{}, Refusal{std::move(reason), std::move(text)}};
}
/// As whoever says something that is not within these limits is told.
[[nodiscard]] inline Decision refused(const Limits& limits) {
  return refused(std::string{limits.reason}, std::string{limits.text});
}
[[nodiscard]] inline Decision nothing_to_do() { return {}; }

/// What decides about the commands of a kind of sender.
class Decider {
 public:
  Decider(const RoomParts& room, const RoomCommand& command, std::int64_t now_us)
      : room_{room}, state_{room.state}, command_{command}, now_us_{now_us} {}

 protected:
  [[nodiscard]] Decision accepted(RoomHappening what) const {
    return {{{state_.seq + 1, now_us_, command_.actor, std::move(what)}}, {}};
  }

  const RoomParts& room_;
  const Room::State& state_;
  const RoomCommand& command_;
  std::int64_t now_us_;
};

/// Names a kind of event.
template <typename Event>
struct OfKind {};

/// Which kind of event this sender asks for in this way, the first if there are several; their number: none.
[[nodiscard]] constexpr std::size_t kind_asked_for(RoomSender sender, std::string_view command) {
  std::size_t i = 0;
  const auto is = [&](const RoomEventKind& kind) {
    return kind.sender == sender && !kind.command.empty() && kind.command == command;
  };
  while (i < kRoomEventKinds.size() && !is(kRoomEventKinds[i])) ++i;
  return i;
}
[[nodiscard]] constexpr bool is_command(RoomSender sender, std::string_view command) {
  return kind_asked_for(sender, command) < kRoomEventKinds.size();
}

/// Reads an event from a command. @return why it cannot be; `incomplete` where the limits say nothing else.
template <typename Event>
[[nodiscard]] std::optional<Refusal> read_asked(const Json& body, std::string_view incomplete, Event& event) {
  std::optional<Refusal> refusal;
  for_each_member(event, [&]<typename T>(const auto& member, T& value) {
    if (refusal || !member.asked) return;
    const auto& limits = *member.asked;
    const auto found = body.find(std::string{member.name});
    if (found == body.end() && (member.may_miss || limits.may_miss || kIsOptional<T>)) return;
    if (found != body.end() && found->is_null() && limits.may_miss && limits.fits == nullptr) return;
    if (found != body.end() && read(*found, value) && is_within(value, limits)) return;
    refusal = {std::string{limits.reason}, std::string{limits.text.empty() ? incomplete : limits.text}};
  });
  return refusal;
}

/// What decider.ask(event) says of the event that is asked for. Every kind that this sender can ask for needs an
/// overload; where there is decider.closed(OfKind<Event>{}), it may decide before the body is looked at.
/// @pre is_command()
template <RoomSender kSender, typename Decider>
[[nodiscard]] Decision asked(const Decider& decider, const RoomCommand& command, std::string_view incomplete) {
  Decision decision;
  const auto decide = [&]<typename Event>(OfKind<Event> kind) {
    if constexpr (requires { decider.closed(kind); }) {
      if (auto closed = decider.closed(kind)) return *std::move(closed);
    }
    Event event;
    if (auto refusal = read_asked(command.body, incomplete, event)) return Decision{{}, std::move(refusal)};
    return decider.ask(std::move(event));
  };
  const auto try_kind = [&]<std::size_t kIndex>(std::integral_constant<std::size_t, kIndex>) {
    using Event = std::variant_alternative_t<kIndex, RoomHappening>;
    if constexpr (kind_asked_for(kSender, Event::kKind.command) == kIndex) {
      if (Event::kKind.command == command.type) decision = decide(OfKind<Event>{});
    }
  };
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (try_kind(std::integral_constant<std::size_t, kIndex>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
  return decision;
}

}  // namespace kith
