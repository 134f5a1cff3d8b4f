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
