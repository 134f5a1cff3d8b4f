#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "kith/core/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace kith {

// What went wrong with a database file, in words; damaged() tells whether its content is at fault rather than the
// disk or the permissions.
class SqliteError : public Error {
 public:
  SqliteError(ErrorKind kind, const std::string& message, int code) : Error{kind, message}, code_{code} {}
  [[nodiscard]] bool damaged() const noexcept;

 private:
  int code_;
};

[[nodiscard]] std::string sqlite_version();

// Of the files that are made here.
inline constexpr int kJournalPageSize = 4096;

class Statement;

// A connection to a database file. All errors are SqliteErrors with the path and the reason. Not thread-safe.
class Database {
 public:
  enum class Mode {
    kMake,   // a new file, to write
    kWrite,  // one that exists, to write
    kRead,   // to read, even while another process writes; nothing is changed, also if it is the last to close the file
    kAlone,  // to read the file alone, whatever is beside it; nobody may write meanwhile
  };
  Database(std::filesystem::path path, Mode mode);
  ~Database();
  Database(Database&& other) noexcept;
  Database& operator=(Database&& other) noexcept;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  void execute(const std::string& sql);
  // Whether the write-ahead log is left as it is, or put into the file when it is long and at the end (the default).
  void keep_log(bool keep);
  // Puts the write-ahead log into the file and empties it.
  void empty_log();
  [[nodiscard]] Statement prepare(const std::string& sql);
  [[noreturn]] void fail(int code) const;

 private:
  [[nodiscard]] int open(const std::string& name, int flags);
  void close() noexcept;

  std::filesystem::path path_;
  bool writes_ = true;
  sqlite3* handle_ = nullptr;
};

class Statement {
 public:
  Statement(const Database& database, sqlite3* handle, const std::string& sql);
  ~Statement();
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;

  // Parameters are numbered from 1. The bytes of a text or blob must live until reset() or the last step.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind_text(int parameter, std::string_view value);
  Statement& bind_blob(int parameter, std::string_view value);
  // Whether there is a row (another row).
  bool step();
  // Runs it to the end and makes it ready to be run again.
  void run();
  void reset();

  // Columns are numbered from 0; views are valid until the next step.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string_view text(int column) const;
  [[nodiscard]] std::string_view blob(int column) const;

 private:
  void check(int code) const;

  const Database* database_;
  sqlite3_stmt* handle_ = nullptr;
};

}  // namespace kith
