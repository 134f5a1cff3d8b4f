#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/live/room_event.hpp"

namespace kith {

// Bodies of commands come from anybody: every member is checked before it is used.

[[nodiscard]] inline Decision refused(std::string reason, std::string text) {
  return {{}, Refusal{std::move(reason), std::move(text)}};
}
[[nodiscard]] inline Decision nothing_to_do() { return {}; }

/// Names a kind of event.
template <typename Event>
struct OfKind {};

/// Whether this sender may ask so.
[[nodiscard]] constexpr bool is_command(RoomSender sender, std::string_view command) {
  for (const auto& kind : kRoomEventKinds) {
    if (kind.sender == sender && !kind.command.empty() && kind.command == command) return true;
  }
  return false;
}

/// What ask(OfKind<Event>{}) decides for the first kind of event that the command leads to. Every kind that this sender
/// can ask for needs an overload. @pre is_command()
template <RoomSender kSender, typename Ask>
[[nodiscard]] Decision asked(std::string_view command, Ask ask) {
  std::optional<Decision> decision;
  const auto try_kind = [&]<typename Event>(OfKind<Event> kind) {
    if constexpr (Event::kKind.sender == kSender && !Event::kKind.command.empty()) {
      if (!decision && Event::kKind.command == command) decision = ask(kind);
    }
  };
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (try_kind(OfKind<std::variant_alternative_t<kIndex, RoomHappening>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
  return *std::move(decision);
}

/// A member that is an integer in [min, max].
[[nodiscard]] std::optional<std::int64_t> integer_in(const Json& body, std::string_view key, std::int64_t min,
                                                     std::int64_t max);
/// A member that is a string of at most `max` bytes of valid UTF-8 without control characters but line breaks.
[[nodiscard]] std::optional<std::string> text_in(const Json& body, std::string_view key, std::size_t max);
[[nodiscard]] bool is_clean_text(const std::string& text, std::size_t max);
/// `actions`: a list of small numbers, as long as a message may be.
[[nodiscard]] std::optional<std::vector<std::size_t>> actions_in(const Json& body);
/// A member that is true or false; a missing one is false.
[[nodiscard]] std::optional<bool> flag_in(const Json& body, std::string_view key);
/// `keys`: what was pressed and when, [[action | "undo" | "reset", ms], ...]; a missing list is empty.
[[nodiscard]] std::optional<Json> keys_in(const Json& body);

}  // namespace kith
