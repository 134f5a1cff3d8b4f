#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "kith/files/sqlite.hpp"
#include "store_identity.hpp"

// The tables of a store, and how files of earlier versions are converted.
namespace kith {

// A step from version `from` to the next one.
struct Migration {
  int from = 0;
  std::string sql;
};

// The steps that there are: none yet.
[[nodiscard]] std::span<const Migration> migrations();

// Sets up a connection that writes.
void prepare_connection(Database& database);

// Makes the tables in an empty file, in one transaction.
void make_tables(Database& database, const StoreFacts& facts);

// Whether the file has no tables yet: a program was killed before it made them.
[[nodiscard]] bool is_empty(Database& database);

[[nodiscard]] int version_of(Database& database);

// Copies a file of an earlier version to PATH.vN.bak and converts it to `version`, step by step in one transaction.
// @throws kith::Error kUsage E1613 if it is of a later version or there is no step from its version.
void migrate(Database& database, int version, std::span<const Migration> steps);

// Whether SQLite finds no fault in the file.
[[nodiscard]] bool is_sound(Database& database);

}  // namespace kith
