#pragma once

#include "kith/files/sqlite.hpp"
#include "store_identity.hpp"

// The tables of a store.
namespace kith {

// Sets up a connection that writes.
void prepare_connection(Database& database);

// Makes the tables in an empty file, in one transaction.
void make_tables(Database& database, const StoreFacts& facts);

// Whether the file has no tables yet: a program was killed before it made them.
[[nodiscard]] bool is_empty(Database& database);

// @throws kith::Error kUsage E1613 if the file is of another version than this program writes.
void require_version(Database& database);

// Rows, with the checksum behind the columns that are read from them.
inline constexpr const char* kSelectRooms = "SELECT number, setup, created_us, checksum FROM room";
inline constexpr const char* kSelectTokens = "SELECT hash, role, room, seat, expires_us, revoked, checksum FROM token";
inline constexpr const char* kSelectEvents = "SELECT room, seq, at_us, actor, type, json, message, checksum FROM event";
[[nodiscard]] StoredRoom room_at(const Statement& row);
[[nodiscard]] StoredToken token_at(const Statement& row);
[[nodiscard]] StoredEvent event_at(const Statement& row);

}  // namespace kith
