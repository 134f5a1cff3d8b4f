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

// Whether SQLite finds no fault in the file.
[[nodiscard]] bool is_sound(Database& database);

}  // namespace kith
