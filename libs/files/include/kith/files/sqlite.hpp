#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "kith/core/error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace kith {

/// An error of a database file, with its path and the reason.
class SqliteError : public Error {
 public:
  SqliteError(ErrorKind kind, const std::string& message, int code) : Error{kind, message}, code_{code} {}
  /// Whether the content of the file is at fault rather than the disk or the permissions.
  [[nodiscard]] bool damaged() const noexcept;

 private:
  int code_;
};

/// The version of SQLite, such as "3.40.1".
[[nodiscard]] std::string sqlite_version();

class Statement;

/// A connection to an SQLite file. All errors are SqliteErrors. Not thread-safe.
class Database {
 public:
  enum class Mode {
    kMake,   ///< A new file, to write.
    kWrite,  ///< One that exists, to write.
    kRead,   ///< To read, even while another process writes. Nothing changes, even if this closes the file last.
    kAlone,  ///< To read the file without the files beside it; no process may write to it meanwhile.
  };
  Database(std::filesystem::path path, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database(Database&& other) noexcept;
  Database& operator=(const Database&) = delete;
  Database& operator=(Database&& other) noexcept;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  void execute(const std::string& sql);
  /// Makes all of a change, or nothing of it if it throws: one transaction. Transactions cannot be nested.
  void transaction(const std::function<void()>& change);
  /// Whether the write-ahead log is kept as it is, or written to the file when it grows long and on closing (the
  /// default).
  void keep_log(bool keep);
  /// Writes the write-ahead log to the file and empties it.
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

/// A prepared statement of a Database, which must outlive it.
class Statement {
 public:
  Statement(const Database& database, sqlite3* handle, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement(Statement&& other) noexcept;
  Statement& operator=(const Statement&) = delete;
  Statement& operator=(Statement&&) = delete;

  // Parameters are numbered from 1. The bytes of a text or blob must live until reset() or the last step.

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind_text(int parameter, std::string_view value);
  Statement& bind_blob(int parameter, std::string_view value);
  Statement& bind_null(int parameter);
  /// Advances to the next row. @return whether there is one.
  bool step();
  /// Runs it to the end and makes it ready to be run again.
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

/// The size of pages of the databases that kith makes.
inline constexpr int kSqlitePageSize = 4096;

/// What a file of kith is: the rows of its table meta(key, value).
[[nodiscard]] std::map<std::string, std::string> read_meta(Database& database);

/// How much is_sound() looks at.
enum class SqliteCheck : std::uint8_t {
  kPages,    ///< Whether all pages can be read and hold what they should.
  kIndexes,  ///< Whether indexes agree with their tables, too.
};

/// Whether SQLite finds no fault in the file.
[[nodiscard]] bool is_sound(Database& database, SqliteCheck check);

/// Visits the rows of a damaged file that SQLite can still read: from the first on, from the last on, with the log
/// beside the file and without it. What SQLite cannot read at all, `sqlite3 FILE .recover` may. A row may come several
/// times, and must tell by a checksum whether it is intact and of this file.
/// @param select  of one table, without an order.
/// @throws kith::Error (kIo) if the file cannot be opened.
void read_remaining_rows(const std::filesystem::path& path, const std::string& select,
                         const std::function<void(const Statement& row)>& visit);

}  // namespace kith
