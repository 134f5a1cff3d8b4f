#pragma once

#include <filesystem>
#include <string>

#include "kith/live/room.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_study.hpp"

namespace kith::testing {

/// A session with rooms of two, "r1", "r2" ..., in the first of which (code AAAAAA) one person joined and consented.
inline void make_session(const std::filesystem::path& folder, int rooms) {
  const auto study = make_session_study(load_study("quick"));
  std::filesystem::create_directories(folder);
  auto file = EventFile::open(folder, {.study = study.digest, .program = "kith test", .inputs = study.inputs},
                              1'700'000'000'000'000);
  if (rooms == 0) return;
  StoreBatch batch;
  for (int number = 1; number <= rooms; ++number) {
    const RoomSetup setup{.id = "r" + std::to_string(number),
                          .code = std::string(6, static_cast<char>('A' + number - 1)),
                          .strategy = "common",
                          .composition = "NP",
                          .replicate = static_cast<std::size_t>(number)};
    batch.rooms.push_back({.number = number, .setup = to_json(setup).dump(), .created_us = 1'700'000'001'000'000});
  }
  batch.events.push_back({.room = 1,
                          .seq = 1,
                          .at_us = 1'700'000'002'000'000,
                          .actor = "server",
                          .type = "joined",
                          .json = R"({"seat":1,"member":0})"});
  batch.events.push_back({.room = 1,
                          .seq = 2,
                          .at_us = 1'700'000'003'000'000,
                          .actor = "seat:1",
                          .type = "consented",
                          .json = R"({"version":"1","query":{}})",
                          .message = "m1"});
  file.write({&batch, 1});
}

}  // namespace kith::testing
