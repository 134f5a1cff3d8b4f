#include <algorithm>
#include <array>
#include <map>
#include <system_error>
#include <utility>
#include <variant>

#include "event_seal.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sqlite_pages.hpp"
#include "kith/store/session_review.hpp"
#include "store_identity.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

using Text = std::string;
using Integer = std::int64_t;

// Rows that were found intact.
struct Found {
  std::map<Integer, StoredRoom> rooms;
  std::map<std::pair<Integer, std::uint64_t>, StoredEvent> events;
  std::map<std::string, StoredToken> tokens;
};

// The identity from the file beside the database or, if that is lost, from the rows of the database.
std::optional<StoreFacts> find_identity(const fs::path& folder) {
  if (auto facts = read_identity_file(folder)) return facts;
  std::map<std::string, std::string> meta;
  constexpr std::array kMeta{SqliteType::kText, SqliteType::kText};
  scan_sqlite_rows(folder / kEventFile, kMeta, [&](const SqliteRow& row) {
    const auto& key = std::get<Text>(row.values[0]);
    constexpr std::array<std::string_view, 6> kKeys{"schema", "id", "study", "program", "created_us", "checksum"};
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end() && key.compare(0, 6, "input/") != 0) return false;
    meta[key] = std::get<Text>(row.values[1]);
    return true;
  });
  return from_meta(meta);
}

void find_rooms(const fs::path& path, const std::string& key, Found& found) {
  constexpr std::array kRoom{SqliteType::kRowNumber, SqliteType::kText, SqliteType::kInteger, SqliteType::kBlob};
  scan_sqlite_rows(path, kRoom, [&](const SqliteRow& row) {
    StoredRoom room{
        .number = row.number, .setup = std::get<Text>(row.values[1]), .created_us = std::get<Integer>(row.values[2])};
    if (std::get<Text>(row.values[3]) != seal(room, key)) return false;
    found.rooms.emplace(room.number, std::move(room));
    return true;
  });
}

void find_tokens(const fs::path& path, const std::string& key, Found& found) {
  constexpr std::array kToken{SqliteType::kBlob,    SqliteType::kText,    SqliteType::kInteger, SqliteType::kInteger,
                              SqliteType::kInteger, SqliteType::kInteger, SqliteType::kBlob};
  scan_sqlite_rows(path, kToken, [&](const SqliteRow& row) {
    StoredToken token{.hash = std::get<Text>(row.values[0]),
                      .role = std::get<Text>(row.values[1]),
                      .room = std::get<Integer>(row.values[2]),
                      .seat = std::get<Integer>(row.values[3]),
                      .expires_us = std::get<Integer>(row.values[4]),
                      .revoked = std::get<Integer>(row.values[5]) != 0};
    if (std::get<Text>(row.values[6]) != seal(token, key)) return false;
    // An older copy of the row may be in the log: what was revoked stays so.
    auto& kept = found.tokens.emplace(token.hash, token).first->second;
    kept.revoked = kept.revoked || token.revoked;
    return true;
  });
}

void find_events(const fs::path& path, const std::string& key, Found& found) {
  constexpr std::array kEvent{SqliteType::kInteger, SqliteType::kInteger, SqliteType::kInteger,    SqliteType::kText,
                              SqliteType::kText,    SqliteType::kText,    SqliteType::kTextOrNull, SqliteType::kBlob};
  scan_sqlite_rows(path, kEvent, [&](const SqliteRow& row) {
    StoredEvent event{.room = std::get<Integer>(row.values[0]),
                      .seq = static_cast<std::uint64_t>(std::get<Integer>(row.values[1])),
                      .at_us = std::get<Integer>(row.values[2]),
                      .actor = std::get<Text>(row.values[3]),
                      .type = std::get<Text>(row.values[4]),
                      .json = std::get<Text>(row.values[5])};
    if (const auto* message = std::get_if<Text>(&row.values[6])) event.message = *message;
    if (std::get<Text>(row.values[7]) != seal(event, key)) return false;
    found.events.emplace(std::pair{event.room, event.seq}, std::move(event));
    return true;
  });
}

// The events of each known room up to the first that is missing; says what had to be left out.
StoreBatch complete_beginnings(const Found& found, SalvageReport& report) {
  StoreBatch batch;
  for (const auto& [number, room] : found.rooms) {
    if (number != 0) batch.rooms.push_back(room);
  }

  // Of each room the events up to the first that is lost.
  Integer current = -1;
  std::uint64_t next = 1;
  std::size_t later = 0;
  const auto finish = [&] {
    if (later == 0) return;
    report.lost.push_back("event " + std::to_string(next) + " of room " + std::to_string(current) + "; " +
                          std::to_string(later) +
                          " later events of this room are intact but cannot be used without it");
  };

  for (const auto& [place, event] : found.events) {
    if (place.first != current) {
      finish();
      current = place.first;
      next = 1;
      later = 0;
    }

    const bool has_room = current == 0 || found.rooms.find(current) != found.rooms.end();
    if (later == 0 && place.second == next && has_room) {
      batch.events.push_back(event);
      ++next;
    } else {
      ++later;
    }
  }
  finish();
  return batch;
}

}  // namespace

SalvageReport salvage_session(const fs::path& folder, const fs::path& target) {
  const auto path = folder / kEventFile;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    refuse_run(ErrorKind::kInvalidInput, "E1616", folder, "the folder holds no session",
               "name the folder that 'kith serve' was given");
  }
  if (fs::exists(target, error) && !fs::is_empty(target, error)) {
    refuse_run(ErrorKind::kUsage, "E1620", target, "the folder for the recovered session is not empty",
               "name a new folder");
  }

  const auto facts = find_identity(folder);
  if (!facts) {
    refuse_run(ErrorKind::kMismatch, "E1619", folder,
               "the identity of the session is lost, and without it no event can be told to be intact",
               "restore session.json, or the whole folder, from a backup");
  }

  const auto key = store_key(facts->id, facts->identity.study);
  Found found;
  find_rooms(path, key, found);
  find_tokens(path, key, found);
  find_events(path, key, found);

  SalvageReport report;
  auto batch = complete_beginnings(found, report);
  for (const auto& [hash, token] : found.tokens) batch.tokens.push_back(token);
  fs::create_directories(target, error);
  if (error) throw Error{ErrorKind::kIo, "cannot make " + target.string() + ": " + error.message()};
  auto file = EventFile::make(target, facts->identity, facts->id, facts->created_us);
  file.write({&batch, 1});

  report.rooms = batch.rooms.size();
  report.events = batch.events.size();
  report.links = batch.tokens.size();
  return report;
}

}  // namespace kith
