#include <map>
#include <system_error>
#include <utility>

#include "event_seal.hpp"
#include "kith/core/error.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sqlite.hpp"
#include "kith/store/session_review.hpp"
#include "store_identity.hpp"
#include "store_schema.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

using Integer = std::int64_t;

// Rows that were found intact.
struct Found {
  std::map<Integer, StoredRoom> rooms;
  std::map<std::pair<Integer, std::uint64_t>, StoredEvent> events;
  std::map<std::string, StoredToken> tokens;
};

// The identity from the file beside the database or, if that is lost, from the database.
std::optional<StoreFacts> find_identity(const fs::path& folder) {
  if (auto facts = read_identity_file(folder)) return facts;
  std::map<std::string, std::string> meta;
  read_remaining_rows(folder / kEventFile, "SELECT key, value FROM meta",
                      [&](const Statement& row) { meta.emplace(row.text(0), row.text(1)); });
  return from_meta(meta);
}

Found find_rows(const fs::path& path, const std::string& key) {
  Found found;
  read_remaining_rows(path, kSelectRooms, [&](const Statement& row) {
    auto room = room_at(row);
    if (row.blob(3) == seal(room, key)) found.rooms.emplace(room.number, std::move(room));
  });
  read_remaining_rows(path, kSelectTokens, [&](const Statement& row) {
    auto token = token_at(row);
    if (row.blob(6) != seal(token, key)) return;
    // The file may have an older copy of the row than the log: what was revoked stays so.
    auto& kept = found.tokens.emplace(token.hash, token).first->second;
    kept.revoked = kept.revoked || token.revoked;
  });
  read_remaining_rows(path, kSelectEvents, [&](const Statement& row) {
    auto event = event_at(row);
    if (row.blob(7) == seal(event, key)) found.events.emplace(std::pair{event.room, event.seq}, std::move(event));
  });
  return found;
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
  const auto found = find_rows(path, key);
  if (found.rooms.empty()) {
    refuse_run(ErrorKind::kMismatch, "E1619", path, "SQLite reads nothing of the session any more",
               "put session.json and what 'sqlite3 session.sqlite .recover | sqlite3 NEW' makes into a new folder, and "
               "salvage that");
  }
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
