#include "kith/store/event_file.hpp"

#include <optional>
#include <system_error>
#include <utility>

#include "event_seal.hpp"
#include "kith/core/error.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sqlite.hpp"
#include "store_identity.hpp"
#include "store_schema.hpp"
#include "write_ahead_log.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_damaged(const fs::path& path, const std::string& what) {
  refuse_run(ErrorKind::kMismatch, "E1612", path, "the session is damaged: " + what,
             "recover the intact events with 'kith session salvage'");
}

[[noreturn]] void refuse_other_study(const fs::path& path) {
  refuse_run(ErrorKind::kMismatch, "E1611", path, "the folder holds a session of another study",
             "use another folder, or the study that the session was started with");
}

// What SQLite says of a file that is no database, or has other tables, is that it is damaged.
template <typename Read>
auto reading(const fs::path& path, Read read) {
  try {
    return read();
  } catch (const SqliteError& error) {
    if (error.damaged()) refuse_damaged(path, "it cannot be read as a database");
    throw;
  }
}

std::string place_of(std::int64_t room, std::uint64_t seq) {
  return "event " + std::to_string(seq) + " of room " + std::to_string(room);
}

}  // namespace

struct EventFile::State {
  fs::path path;
  Database database;
  StoreFacts facts;
  std::string key;

  State(fs::path where, Database file, StoreFacts whose)
      : path{std::move(where)},
        database{std::move(file)},
        facts{std::move(whose)},
        key{store_key(facts.id, facts.identity.study)} {}

  void insert(const StoreBatch& batch) {
    auto room = database.prepare("INSERT INTO room VALUES (?, ?, ?, ?)");
    for (const auto& row : batch.rooms) {
      const auto checksum = seal(row, key);
      room.bind(1, row.number).bind_text(2, row.setup).bind(3, row.created_us).bind_blob(4, checksum).run();
    }

    auto token = database.prepare("INSERT INTO token VALUES (?, ?, ?, ?, ?, ?, ?)");
    for (const auto& row : batch.tokens) {
      const auto checksum = seal(row, key);
      token.bind_blob(1, row.hash).bind_text(2, row.role).bind(3, row.room).bind(4, row.seat).bind(5, row.expires_us);
      token.bind(6, std::int64_t{row.revoked ? 1 : 0}).bind_blob(7, checksum).run();
    }

    for (const auto& hash : batch.revoked) revoke(hash);

    auto event = database.prepare("INSERT INTO event VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    for (const auto& row : batch.events) {
      const auto checksum = seal(row, key);
      event.bind(1, row.room).bind(2, static_cast<std::int64_t>(row.seq)).bind(3, row.at_us).bind_text(4, row.actor);
      event.bind_text(5, row.type).bind_text(6, row.json);
      row.message ? event.bind_text(7, *row.message) : event.bind_null(7);
      event.bind_blob(8, checksum).run();
    }
  }

  void revoke(const std::string& hash) {
    for (auto& row : tokens()) {
      if (row.hash != hash) continue;
      row.revoked = true;
      const auto checksum = seal(row, key);
      auto update = database.prepare("UPDATE token SET revoked = 1, checksum = ? WHERE hash = ?");
      update.bind_blob(1, checksum).bind_blob(2, hash).run();
    }
  }

  [[nodiscard]] std::vector<StoredToken> tokens() {
    std::vector<StoredToken> all;
    auto rows = database.prepare(kSelectTokens);
    while (rows.step()) {
      auto token = token_at(rows);
      if (rows.blob(6) != seal(token, key)) refuse_damaged(path, "a link has a wrong checksum");
      all.push_back(std::move(token));
    }
    return all;
  }
};

EventFile::EventFile(std::unique_ptr<State> state) : state_{std::move(state)} {}
EventFile::EventFile(EventFile&&) noexcept = default;
EventFile& EventFile::operator=(EventFile&&) noexcept = default;
EventFile::~EventFile() = default;

EventFile EventFile::open(const fs::path& folder, const StoreIdentity& identity, std::int64_t now_us) {
  const auto path = folder / kEventFile;
  std::error_code none;
  const auto beside = read_identity_file(folder);
  if (beside && beside->identity.study != identity.study) refuse_other_study(path);
  if (!fs::exists(path, none)) return make(folder, identity, beside ? beside->id : new_store_id(), now_us);
  return reading(path, [&]() -> EventFile {
    if (log_is_damaged(path)) refuse_damaged(path, "its write-ahead log has a wrong checksum");
    Database database{path, Database::Mode::kWrite};
    prepare_connection(database);
    if (is_empty(database)) {
      return make(folder, identity, beside ? beside->id : new_store_id(), now_us);
    }
    if (!is_sound(database, SqliteCheck::kIndexes)) refuse_damaged(path, "SQLite's check of the file fails");
    require_version(database);
    const auto facts = from_meta(read_meta(database));
    if (!facts) refuse_damaged(path, "its description has a wrong checksum");
    if (facts->identity.study != identity.study) refuse_other_study(path);
    if (!beside) write_identity_file(folder, *facts);
    return EventFile{std::make_unique<State>(path, std::move(database), *facts)};
  });
}

EventFile EventFile::read(const fs::path& folder) {
  const auto path = folder / kEventFile;
  std::error_code none;
  if (!fs::is_regular_file(path, none)) {
    refuse_run(ErrorKind::kInvalidInput, "E1616", folder, "the folder holds no session",
               "name the folder that 'kith serve' was given");
  }
  return reading(path, [&]() -> EventFile {
    if (log_is_damaged(path)) refuse_damaged(path, "its write-ahead log has a wrong checksum");
    // Beside a writer the file alone is not enough, even if it has no log yet.
    Database database{path, is_busy(folder) ? Database::Mode::kWrite : Database::Mode::kRead};
    database.execute("PRAGMA query_only = ON");
    require_version(database);
    database.execute("BEGIN");
    const auto facts = from_meta(read_meta(database));
    if (!facts) refuse_damaged(path, "its description has a wrong checksum");
    return EventFile{std::make_unique<State>(path, std::move(database), *facts)};
  });
}

EventFile EventFile::make(const fs::path& folder, const StoreIdentity& identity, const std::string& id,
                          std::int64_t now_us) {
  const auto path = folder / kEventFile;
  const StoreFacts facts{.identity = identity, .id = id, .created_us = now_us};
  write_identity_file(folder, facts);
  Database database{path, Database::Mode::kMake};
  prepare_connection(database);
  make_tables(database, facts);
  EventFile file{std::make_unique<State>(path, std::move(database), facts)};
  StoreBatch service;
  service.rooms.push_back({.number = 0, .setup = "{}", .created_us = now_us});
  file.write({&service, 1});
  return file;
}

const fs::path& EventFile::path() const noexcept { return state_->path; }
const StoreIdentity& EventFile::identity() const noexcept { return state_->facts.identity; }
const std::string& EventFile::id() const noexcept { return state_->facts.id; }
std::int64_t EventFile::created_us() const noexcept { return state_->facts.created_us; }

std::vector<StoredRoom> EventFile::rooms() {
  return reading(state_->path, [&] {
    std::vector<StoredRoom> rooms;
    auto rows = state_->database.prepare(std::string{kSelectRooms} + " ORDER BY number");
    while (rows.step()) {
      auto room = room_at(rows);
      if (rows.blob(3) != seal(room, state_->key))
        refuse_damaged(state_->path, "room " + std::to_string(room.number) + " has a wrong checksum");
      if (room.number != 0) rooms.push_back(std::move(room));
    }
    return rooms;
  });
}

std::vector<StoredToken> EventFile::tokens() {
  return reading(state_->path, [&] { return state_->tokens(); });
}

void EventFile::for_each_event(const std::function<void(const StoredEvent&)>& visit, std::optional<std::int64_t> room) {
  auto rows = reading(state_->path, [&] {
    return state_->database.prepare(std::string{kSelectEvents} + (room ? " WHERE room = ?" : "") +
                                    " ORDER BY room, seq");
  });
  if (room) rows.bind(1, *room);
  std::int64_t current = -1;
  std::uint64_t next = 1;
  while (reading(state_->path, [&] { return rows.step(); })) {
    const auto event = event_at(rows);
    if (event.room != std::exchange(current, event.room)) next = 1;
    if (rows.blob(7) != seal(event, state_->key))
      refuse_damaged(state_->path, place_of(event.room, event.seq) + " has a wrong checksum");
    if (event.seq != next) refuse_damaged(state_->path, place_of(event.room, next) + " is missing");
    ++next;
    visit(event);
  }
}

std::uint64_t EventFile::count_events(std::optional<std::int64_t> room) {
  return reading(state_->path, [&] {
    auto count = state_->database.prepare(std::string{"SELECT count(*) FROM event"} + (room ? " WHERE room = ?" : ""));
    if (room) count.bind(1, *room);
    return count.step() ? static_cast<std::uint64_t>(count.integer(0)) : 0;
  });
}

void EventFile::verify() {
  if (!reading(state_->path, [&] { return is_sound(state_->database, SqliteCheck::kIndexes); }))
    refuse_damaged(state_->path, "SQLite's check of the file fails");
  static_cast<void>(rooms());
  static_cast<void>(tokens());
  for_each_event([](const StoredEvent&) {});
}

void EventFile::write(std::span<const StoreBatch> batches) {
  state_->database.transaction([&] {
    for (const auto& batch : batches) state_->insert(batch);
  });
}

void EventFile::rewrite(std::span<const StoredEvent> events) {
  auto& database = state_->database;
  database.transaction([&] {
    auto update = database.prepare("UPDATE event SET json = ?, checksum = ?, at_us = ? WHERE room = ? AND seq = ?");
    for (const auto& event : events) {
      const auto checksum = seal(event, state_->key);
      update.bind_text(1, event.json).bind_blob(2, checksum).bind(3, event.at_us).bind(4, event.room);
      update.bind(5, static_cast<std::int64_t>(event.seq)).run();
    }
  });
  database.execute("VACUUM");
  database.empty_log();
}

void EventFile::reopen() {
  Database database{state_->path, Database::Mode::kWrite};
  prepare_connection(database);
  state_->database = std::move(database);
}

}  // namespace kith
