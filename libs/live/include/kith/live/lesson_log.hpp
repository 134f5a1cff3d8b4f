#pragma once

#include <cstdint>
#include <string>

#include "kith/live/room_event.hpp"
#include "kith/live/teaching_task.hpp"

// What a lesson file and whoever imports its log say alike.
namespace kith {

/// {seq, at_us, actor, type, body}.
[[nodiscard]] Json to_json(const RoomEvent& event);
/// And back. @throws kith::Error (kInvalidInput, kMismatch) if it is no event.
[[nodiscard]] RoomEvent room_event(const Json& json);

/// {seq, demos, tests}: what the lesson of an event shows and asks, by numbers of the atlas. Empty lists if there was
/// no further lesson.
[[nodiscard]] Json lesson_content(const TaughtLesson& lesson, std::uint64_t seq);

/// The seal of a list of events, from that of the list without its last one (empty: of none). SHA-256, hexadecimal.
[[nodiscard]] std::string sealed(const std::string& before, const RoomEvent& last);

}  // namespace kith
