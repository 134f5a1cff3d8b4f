#include "kith/files/sqlite.hpp"

#include <sqlite3.h>

#include <system_error>
#include <utility>

namespace kith {
namespace {

constexpr int kPrimary = 0xFF;  // the lower byte of an extended result code

std::string reason(int code, int error) {
  switch (code & kPrimary) {
    case SQLITE_FULL:
      return "the disk is full";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "the file is damaged";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another process uses it";
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return "permission denied";
    case SQLITE_NOMEM:
      return "out of memory";
    default:
      return error != 0 ? std::generic_category().message(error) : sqlite3_errstr(code);
  }
}

}  // namespace

std::string sqlite_version() { return sqlite3_libversion(); }

bool SqliteError::damaged() const noexcept {
  const int primary = code_ & kPrimary;
  return primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB || primary == SQLITE_SCHEMA || primary == SQLITE_ERROR ||
         primary == SQLITE_MISMATCH;
}

namespace {

// The name under which SQLite opens a file without looking at what is beside it.
std::string name_of_file_alone(const std::filesystem::path& path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string name{"file:"};
  for (const char c : std::filesystem::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#' || byte < 0x21 || byte > 0x7E) {
      name += {'%', kDigits[byte >> 4], kDigits[byte & 15u]};
    } else {
      name += c;
    }
  }
  return name + "?immutable=1";
}

bool has_log(const std::filesystem::path& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(std::filesystem::path{path}.concat("-wal"), none);
  return !none && size > 0;
}

}  // namespace

int Database::open(const std::string& name, int flags) {
  const int code = sqlite3_open_v2(name.c_str(), &handle_, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) return code;
  sqlite3_extended_result_codes(handle_, 1);
  sqlite3_busy_timeout(handle_, 2000);  // a reader of the progress holds the file for an instant
  return code;
}

Database::Database(std::filesystem::path path, Mode mode)
    : path_{std::move(path)}, writes_{mode == Mode::kMake || mode == Mode::kWrite} {
  int code = SQLITE_OK;
  if (writes_) {
    code = open(path_, SQLITE_OPEN_READWRITE | (mode == Mode::kMake ? SQLITE_OPEN_CREATE : 0));
  } else if (mode == Mode::kRead && has_log(path_)) {
    // The log can only be read by those who can write beside it; where we cannot, SQLite may still find a way.
    code = open(path_, SQLITE_OPEN_READWRITE);
    if (code == SQLITE_OK) keep_log(true);
    if (code == SQLITE_OK && sqlite3_db_readonly(handle_, "main") == 1) {
      close();
      code = open(path_, SQLITE_OPEN_READONLY);
    }
  } else {
    code = open(name_of_file_alone(path_), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
  }
  if (code == SQLITE_OK) return;
  const int error = handle_ != nullptr ? sqlite3_system_errno(handle_) : 0;
  close();
  throw SqliteError{
      ErrorKind::kIo,
      std::string{"cannot "} + (writes_ ? "write " : "read ") + path_.string() + ": " + reason(code, error), code};
}

void Database::keep_log(bool keep) {
  constexpr int kPages = 1000;  // SQLite's own choice
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, keep ? 1 : 0, nullptr);
  sqlite3_wal_autocheckpoint(handle_, keep ? 0 : kPages);
}

void Database::empty_log() {
  auto checkpoint = prepare("PRAGMA wal_checkpoint(TRUNCATE)");
  if (!checkpoint.step() || checkpoint.integer(0) != 0) fail(SQLITE_BUSY);
}

Database::~Database() { close(); }

Database::Database(Database&& other) noexcept
    : path_{std::move(other.path_)}, writes_{other.writes_}, handle_{std::exchange(other.handle_, nullptr)} {}

Database& Database::operator=(Database&& other) noexcept {
  if (this == &other) return *this;
  close();
  path_ = std::move(other.path_);
  writes_ = other.writes_;
  handle_ = std::exchange(other.handle_, nullptr);
  return *this;
}

void Database::close() noexcept { sqlite3_close_v2(std::exchange(handle_, nullptr)); }

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

void Database::transaction(const std::function<void()>& change) {
  execute("BEGIN IMMEDIATE");
  try {
    change();
    execute("COMMIT");
  } catch (...) {
    try {
      execute("ROLLBACK");
    } catch (const SqliteError&) {  // SQLite has rolled back by itself
    }
    throw;
  }
}

Statement Database::prepare(const std::string& sql) { return {*this, handle_, sql}; }

void Database::fail(int code) const {
  const bool busy = (code & kPrimary) == SQLITE_BUSY || (code & kPrimary) == SQLITE_LOCKED;
  throw SqliteError{busy ? ErrorKind::kBusy : ErrorKind::kIo,
                    std::string{"cannot "} + (writes_ ? "write " : "read ") + path_.string() + ": " +
                        reason(code, sqlite3_system_errno(handle_)),
                    code};
}

Statement::Statement(const Database& database, sqlite3* handle, const std::string& sql) : database_{&database} {
  const int code = sqlite3_prepare_v2(handle, sql.c_str(), static_cast<int>(sql.size()), &handle_, nullptr);
  if (code != SQLITE_OK) database.fail(code);
}

Statement::~Statement() { sqlite3_finalize(handle_); }

Statement::Statement(Statement&& other) noexcept
    : database_{other.database_}, handle_{std::exchange(other.handle_, nullptr)} {}

void Statement::check(int code) const {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) database_->fail(code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(handle_, parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(handle_, parameter, value));
  return *this;
}

Statement& Statement::bind_text(int parameter, std::string_view value) {
  check(sqlite3_bind_text64(handle_, parameter, value.data(), value.size(), SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_blob(int parameter, std::string_view value) {
  check(sqlite3_bind_blob64(handle_, parameter, value.data(), value.size(), SQLITE_STATIC));
  return *this;
}

Statement& Statement::bind_null(int parameter) {
  check(sqlite3_bind_null(handle_, parameter));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  check(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() { check(sqlite3_reset(handle_)); }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }
double Statement::real(int column) const { return sqlite3_column_double(handle_, column); }

std::string_view Statement::text(int column) const { return blob(column); }

std::string_view Statement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(handle_, column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_, column));
  return bytes == nullptr ? std::string_view{} : std::string_view{static_cast<const char*>(bytes), size};
}

std::map<std::string, std::string> read_meta(Database& database) {
  std::map<std::string, std::string> meta;
  auto rows = database.prepare("SELECT key, value FROM meta");
  while (rows.step()) meta.emplace(rows.text(0), rows.text(1));
  return meta;
}

bool is_sound(Database& database, SqliteCheck check) {
  try {
    auto found = database.prepare(check == SqliteCheck::kPages ? "PRAGMA quick_check(1)" : "PRAGMA integrity_check(1)");
    return found.step() && found.text(0) == "ok";
  } catch (const SqliteError& error) {
    if (error.damaged()) return false;
    throw;
  }
}

void read_remaining_rows(const std::filesystem::path& path, const std::string& select,
                         const std::function<void(const Statement& row)>& visit) {
  for (const auto mode : {Database::Mode::kRead, Database::Mode::kAlone}) {
    for (const auto* order : {" ORDER BY rowid", " ORDER BY rowid DESC"}) {
      try {
        Database database{path, mode};
        database.execute("PRAGMA writable_schema = ON");  // reads on where another table's description is damaged
        auto rows = database.prepare(select + order);
        while (rows.step()) visit(rows);
      } catch (const SqliteError& error) {
        if (!error.damaged()) throw;
      }
    }
  }
}

}  // namespace kith
