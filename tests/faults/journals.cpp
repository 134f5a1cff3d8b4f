#include "journals.hpp"

#include <sqlite3.h>

#include <memory>

#include "kith/core/error.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

struct Close {
  void operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }
  void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
};
using Handle = std::unique_ptr<sqlite3, Close>;
using Statement = std::unique_ptr<sqlite3_stmt, Close>;

Handle open(const fs::path& path) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  Handle owner{handle};
  if (code != SQLITE_OK) return nullptr;
  // Reads on where the list of tables is damaged in a place that does not matter.
  (void)sqlite3_exec(handle, "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
  return owner;
}

Statement prepare(const Handle& database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  (void)sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &statement, nullptr);
  return Statement{statement};
}

std::string bytes(sqlite3_stmt* statement, int column) {
  const void* const data = sqlite3_column_blob(statement, column);
  return data == nullptr ? std::string{}
                         : std::string{static_cast<const char*>(data),
                                       static_cast<std::size_t>(sqlite3_column_bytes(statement, column))};
}

bool step(const Statement& statement) { return statement && sqlite3_step(statement.get()) == SQLITE_ROW; }

// The table of records is the one with an integer key and a blob.
void find_table(const Handle& database, Records& records) {
  const auto rows = prepare(database,
                            "SELECT m.name, k.name, b.name FROM sqlite_schema m JOIN pragma_table_info(m.name) k ON "
                            "k.pk = 1 AND k.type = 'INTEGER' JOIN pragma_table_info(m.name) b ON b.type = 'BLOB'");
  if (!step(rows)) return;
  records.table = bytes(rows.get(), 0);
  records.number = bytes(rows.get(), 1);
  records.content = bytes(rows.get(), 2);
}

bool is_database(const std::string& name) {
  for (const std::string part : {"-wal", "-shm", "-journal"}) {
    if (name.size() >= part.size() && name.compare(name.size() - part.size(), part.size(), part) == 0) return false;
  }
  return true;
}

// Adds the numbers of the records that can be read from the databases of a folder.
void read_all(const fs::path& folder, const Records& records, std::set<std::int64_t>& readable) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator{folder}) names.insert(entry.path().filename().string());
  for (const auto& name : names) {
    if (!is_database(name)) continue;
    const auto database = open(folder / name);
    if (!database) continue;
    const auto row =
        prepare(database, "SELECT " + records.content + " FROM " + records.table + " WHERE " + records.number + " = ?");
    if (!row) continue;
    for (const auto& [number, forms] : records.forms) {
      sqlite3_bind_int64(row.get(), 1, number);
      if (step(row) && forms.count(bytes(row.get(), 0)) > 0) readable.insert(number);
      sqlite3_reset(row.get());
    }
  }
}

}  // namespace

void add_records(const fs::path& journal, Records& records) {
  const auto database = open(journal);
  if (database && records.table.empty()) find_table(database, records);
  if (records.table.empty()) throw Error{ErrorKind::kIo, journal.string() + " has no table of records"};
  const auto rows = prepare(database, "SELECT " + records.number + ", " + records.content + " FROM " + records.table);
  while (step(rows)) records.forms[sqlite3_column_int64(rows.get(), 0)].insert(bytes(rows.get(), 1));
}

std::set<std::int64_t> readable_records(const fs::path& folder, const Records& records, const fs::path& scratch) {
  std::set<std::int64_t> readable;
  if (!fs::is_directory(folder)) return readable;
  // As they are, and each without the log beside it, which may be foreign.
  for (const bool with_logs : {true, false}) {
    fs::create_directory(scratch);
    for (const auto& entry : fs::directory_iterator{folder}) {
      const auto name = entry.path().filename().string();
      if (!entry.is_regular_file() || name.find(".sqlite") == std::string::npos) continue;
      if (with_logs || is_database(name)) fs::copy_file(entry.path(), scratch / name);
    }
    read_all(scratch, records, readable);
    fs::remove_all(scratch);
  }
  return readable;
}

}  // namespace kith::faults
