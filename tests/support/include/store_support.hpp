#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/store/event_store.hpp"
#include "scratch_folder.hpp"

namespace kith::testing {

inline constexpr std::int64_t kSomeTime = 1'700'000'000'000'000;

[[nodiscard]] inline StoreIdentity identity_of(const std::string& study = "study") {
  return {.study = study, .program = "kith test", .inputs = {{"study.toml", "id = \"x\"\n"}}};
}

/// An event of a room whose content tells its place; some are longer than a page.
[[nodiscard]] inline StoredEvent event_of(std::int64_t room, std::uint64_t seq) {
  const std::size_t length = seq % 7 == 0 ? 9000 : 40;
  StoredEvent event{.room = room,
                    .seq = seq,
                    .at_us = 1'700'000'000'000'000 + static_cast<std::int64_t>(seq) * 1000,
                    .actor = "seat:" + std::to_string(seq % 3 + 1),
                    .type = "answered",
                    .json = "{\"place\":\"" + std::to_string(room) + "/" + std::to_string(seq) + "\",\"filler\":\"" +
                            std::string(length, static_cast<char>('a' + seq % 26)) + "\"}"};
  if (seq % 2 == 0) event.message = "message-" + std::to_string(room) + "-" + std::to_string(seq);
  return event;
}

[[nodiscard]] inline StoredRoom room_of(std::int64_t number) {
  return {.number = number, .setup = "{\"id\":\"r" + std::to_string(number) + "\"}", .created_us = 1000 + number};
}

[[nodiscard]] inline StoreBatch batch_of(std::vector<StoredEvent> events, std::vector<StoredRoom> rooms = {}) {
  StoreBatch batch;
  batch.rooms = std::move(rooms);
  batch.events = std::move(events);
  return batch;
}

/// All events of a file, in order.
[[nodiscard]] inline std::vector<StoredEvent> events_in(EventFile& file) {
  std::vector<StoredEvent> events;
  file.for_each_event([&](const StoredEvent& event) { events.push_back(event); });
  return events;
}

/// The id of the diagnostic that the action throws; "" if it throws nothing, "?" for an error without an id.
template <typename Action>
[[nodiscard]] std::string id_of_error(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.diagnostics().empty() || error.diagnostics().front().id.empty() ? "?" : error.diagnostics().front().id;
  }
  return "";
}

inline void flip_bit(const std::filesystem::path& path, std::size_t byte, unsigned bit) {
  std::fstream file{path, std::ios::in | std::ios::out | std::ios::binary};
  file.seekg(static_cast<std::streamoff>(byte));
  const auto old = static_cast<unsigned char>(file.get());
  file.seekp(static_cast<std::streamoff>(byte));
  file.put(static_cast<char>(old ^ (1u << bit)));
}

}  // namespace kith::testing
