#include "store_schema.hpp"

#include "kith/files/published_run.hpp"
#include "kith/files/sqlite.hpp"

namespace kith {
namespace {

constexpr const char* kTables =
    "PRAGMA application_id = 0x6B697468;"  // "kith"
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;"
    "CREATE TABLE room(number INTEGER PRIMARY KEY, setup TEXT NOT NULL, created_us INTEGER NOT NULL,"
    " checksum BLOB NOT NULL) STRICT;"
    "CREATE TABLE event(room INTEGER NOT NULL REFERENCES room(number), seq INTEGER NOT NULL, at_us INTEGER NOT NULL,"
    " actor TEXT NOT NULL, type TEXT NOT NULL, json TEXT NOT NULL, message TEXT, checksum BLOB NOT NULL,"
    " PRIMARY KEY(room, seq)) STRICT;"
    "CREATE UNIQUE INDEX message ON event(room, actor, message) WHERE message IS NOT NULL;"
    "CREATE TABLE token(hash BLOB NOT NULL, role TEXT NOT NULL, room INTEGER NOT NULL, seat INTEGER NOT NULL,"
    " expires_us INTEGER NOT NULL, revoked INTEGER NOT NULL, checksum BLOB NOT NULL, UNIQUE(hash)) STRICT;";

}  // namespace

StoredRoom room_at(const Statement& row) {
  return {.number = row.integer(0), .setup = std::string{row.text(1)}, .created_us = row.integer(2)};
}

StoredToken token_at(const Statement& row) {
  return {.hash = std::string{row.blob(0)},
          .role = std::string{row.text(1)},
          .room = row.integer(2),
          .seat = row.integer(3),
          .expires_us = row.integer(4),
          .revoked = row.integer(5) != 0};
}

StoredEvent event_at(const Statement& row) {
  StoredEvent event{.room = row.integer(0),
                    .seq = static_cast<std::uint64_t>(row.integer(1)),
                    .at_us = row.integer(2),
                    .actor = std::string{row.text(3)},
                    .type = std::string{row.text(4)},
                    .json = std::string{row.text(5)}};
  if (!row.text(6).empty()) event.message = std::string{row.text(6)};
  return event;
}

void prepare_connection(Database& database) {
  database.execute(
      "PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA secure_delete = ON; PRAGMA temp_store = MEMORY");
}

void make_tables(Database& database, const StoreFacts& facts) {
  database.execute("PRAGMA page_size = " + std::to_string(kSqlitePageSize) + "; PRAGMA journal_mode = WAL");
  database.transaction([&] {
    database.execute(kTables);
    auto insert = database.prepare("INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] : to_meta(facts)) insert.bind_text(1, key).bind_text(2, value).run();
    database.execute("PRAGMA user_version = " + std::to_string(EventFile::kVersion));
  });
}

bool is_empty(Database& database) {
  auto tables = database.prepare("SELECT count(*) FROM sqlite_schema");
  return tables.step() && tables.integer(0) == 0;
}

void require_version(Database& database) {
  auto version = database.prepare("PRAGMA user_version");
  const auto found = version.step() ? version.integer(0) : 0;
  if (found == EventFile::kVersion) return;
  refuse_run(ErrorKind::kUsage, "E1613", database.path(),
             "the session was written by another version of kith (its file has version " + std::to_string(found) +
                 ", this program reads version " + std::to_string(EventFile::kVersion) + ")",
             "use the version of kith that made it, or another folder");
}

}  // namespace kith
