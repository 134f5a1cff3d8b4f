#include "journal_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/sha256.hpp"
#include "kith/runs/team_codec.hpp"
#include "kith/study/study.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "kith.journal/3";

constexpr const char* kTables =
    "PRAGMA application_id = 0x6B697468;"  // "kith"
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;"
    "CREATE TABLE units(team INTEGER PRIMARY KEY, record BLOB NOT NULL) STRICT;"
    "CREATE TABLE failures(team INTEGER PRIMARY KEY, message BLOB NOT NULL) STRICT;"
    "CREATE TABLE sessions(id INTEGER PRIMARY KEY, started REAL NOT NULL) STRICT;"
    "CREATE TABLE batches(id INTEGER PRIMARY KEY, session INTEGER NOT NULL, written REAL NOT NULL,"
    " teams INTEGER NOT NULL) STRICT;";

fs::path beside(const fs::path& path, const char* suffix) { return fs::path{path}.concat(suffix); }

// A line for each file: its hash and its name, which has no line break.
std::string text_of(const std::vector<InputFile>& files) {
  std::string text;
  for (const auto& file : files) text += file.sha256 + " " + file.name + "\n";
  return text;
}

std::vector<InputFile> files_from(const std::string& text) {
  std::vector<InputFile> files;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto space = std::min(text.find(' ', begin), end);
    files.push_back(
        {text.substr(std::min(space + 1, end), end - std::min(space + 1, end)), text.substr(begin, space - begin), ""});
    begin = end + 1;
  }
  return files;
}

std::vector<std::pair<std::string, std::string>> meta_of(const JournalIdentity& identity) {
  std::vector<std::pair<std::string, std::string>> meta{{"schema", kSchema},
                                                        {"run", identity.inputs.digest()},
                                                        {"program", identity.program},
                                                        {"study", identity.inputs.study},
                                                        {"domain", identity.inputs.domain},
                                                        {"files", text_of(identity.inputs.files)},
                                                        {"teams", std::to_string(identity.teams)},
                                                        {"shard", std::to_string(identity.shard.index)},
                                                        {"shards", std::to_string(identity.shard.count)}};
  Sha256 hash;
  for (const auto& [key, value] : meta) hash.update(key + "=" + value + "\n");
  meta.emplace_back("checksum", std::move(hash).hex());
  return meta;
}

// Zero for what is no number.
std::size_t number_of(const std::string& text) {
  std::size_t value = 0;
  const auto end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && rest == end ? value : 0;
}

// "kith.journal/7"; what is not of this form is damage, not another version.
bool is_schema(const std::string& text) {
  const std::string begin{"kith.journal/"};
  return text.size() > begin.size() && text.compare(0, begin.size(), begin) == 0 &&
         number_of(text.substr(begin.size())) > 0;
}

bool makes_sense(const JournalIdentity& identity) {
  const auto& [index, count] = identity.shard;
  return identity.teams >= 1 && identity.teams <= kMaxTeams && index >= 1 && index <= count;
}

// @throws kith::Error
void synchronise(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synchronised = file >= 0 && fsync(file) == 0;
  const int error = errno;
  if (file >= 0) close(file);
  if (!synchronised) {
    throw Error{ErrorKind::kIo, "cannot write " + path.string() + ": " + std::generic_category().message(error)};
  }
}

void rename_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw Error{ErrorKind::kIo, "cannot write " + to.string() + ": " + error.message()};
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw Error{ErrorKind::kIo, "cannot remove " + path.string() + ": " + error.message()};
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path{"."}; }

// Makes it under another name first. The file is complete before it has its own, so whoever finds it finds a journal;
// therefore one synchronisation at the end will do, instead of one for each of SQLite's steps.
void fill_file(const fs::path& path, const JournalIdentity& identity, const std::function<void(Database&)>& rows) {
  for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) remove_file(beside(path, suffix));
  {
    Database database{path, Database::Mode::kMake};
    database.execute("PRAGMA page_size = " + std::to_string(kSqlitePageSize) +
                     "; PRAGMA synchronous = OFF; PRAGMA journal_mode = WAL; BEGIN");
    database.execute(kTables);
    auto insert = database.prepare("INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] : meta_of(identity)) insert.bind_text(1, key).bind_text(2, value).run();
    if (rows) rows(database);
    database.execute("COMMIT");
    database.empty_log();  // closing would do it too, and say nothing if the disk is full
  }
  synchronise(path);
  Database check{path, Database::Mode::kAlone};
  const auto written = read_identity(check);
  if (!written || *written != identity) throw Error{ErrorKind::kIo, "cannot write " + path.string()};
}

// The same; nothing remains of it if it fails, on a full disk for instance.
void fill(const fs::path& path, const JournalIdentity& identity, const std::function<void(Database&)>& rows) try {
  fill_file(path, identity, rows);
} catch (...) {
  for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    fs::remove(beside(path, suffix), ignored);
  }
  throw;
}

constexpr const char* kNew = ".new";
constexpr const char* kSalvaging = ".salvaging";

}  // namespace

void remove_unfinished_journals(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end; entry.increment(error)) {
    const auto name = entry->path().filename().string();
    for (const auto* suffix : {kNew, kSalvaging}) {
      if (name.rfind("study.", 0) == 0 && name.find(std::string{".sqlite"} + suffix) != std::string::npos)
        left.push_back(entry->path());
    }
  }
  for (const auto& file : left) remove_file(file);
}

bool is_there(const fs::path& path) {
  std::error_code error;
  const auto type = fs::symlink_status(path, error).type();
  if (type == fs::file_type::not_found) return false;
  if (error) throw Error{ErrorKind::kIo, "cannot read " + path.string() + ": " + error.message()};
  return true;
}

std::optional<fs::path> current_file(const fs::path& path) {
  const auto file = is_there(salvaged_file(path)) ? salvaged_file(path) : path;
  if (!is_there(file)) return std::nullopt;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw Error{ErrorKind::kIo, file.string() + " is not a regular file, so it is not the journal of a study",
                Advice{"remove it", Remedy::kStartOver}};
  }
  return file;
}

void make_journal_file(const fs::path& path, const JournalIdentity& identity) {
  const auto fresh = beside(path, kNew);
  fill(fresh, identity, {});
  rename_file(fresh, path);
  synchronise_folder(folder_of(path));
}

std::optional<JournalIdentity> read_identity(Database& database) try {
  const auto meta = read_meta(database);
  const auto value_of = [&](const std::string& key) {
    const auto at = meta.find(key);
    return at == meta.end() ? std::string{} : at->second;
  };
  JournalIdentity identity{{value_of("study"), value_of("domain"), files_from(value_of("files"))},
                           value_of("program"),
                           number_of(value_of("teams")),
                           {number_of(value_of("shard")), number_of(value_of("shards"))}};
  std::vector<std::string> wrong;
  for (const auto& [key, value] : meta_of(identity)) {
    if (value_of(key) != value) wrong.push_back(key);
  }
  const auto schema = value_of("schema");
  if (wrong.size() > 1 && is_schema(schema) && schema != kSchema) {
    throw Error{
        ErrorKind::kUsage,
        database.path().string() + " was written by another version of kith (" + schema + ", not " + kSchema + ")",
        Remedy::kStartOver};
  }
  if (!wrong.empty() || !makes_sense(identity)) return std::nullopt;
  return identity;
} catch (const SqliteError& error) {
  if (error.damaged()) return std::nullopt;
  throw;
}

bool belongs(const JournalIdentity& identity, std::int64_t team) {
  return team >= 1 && static_cast<std::size_t>(team) <= identity.teams &&
         identity.shard.contains(static_cast<std::size_t>(team));
}

fs::path salvaged_file(const fs::path& path) { return beside(path, ".salvaged"); }

bool salvage_journal(const fs::path& path, const JournalIdentity& identity, bool known) {
  const auto fresh = beside(path, kSalvaging);
  std::size_t found = 0;
  const auto key = identity.key();
  fill(fresh, identity, [&](Database& database) {
    auto insert = database.prepare("INSERT OR IGNORE INTO units VALUES (?, ?)");
    read_remaining_rows(path, "SELECT team, record FROM units", [&](const Statement& row) {
      const auto team = row.integer(0);
      if (!belongs(identity, team) || !is_intact(static_cast<std::size_t>(team), row.blob(1), key)) return;
      ++found;
      insert.bind(1, team).bind_blob(2, row.blob(1)).run();
    });
  });
  if (found == 0 && !known) {
    remove_file(fresh);
    return false;
  }
  rename_file(fresh, salvaged_file(path));
  synchronise_folder(folder_of(path));
  replace_by_salvaged(path);
  return true;
}

void replace_by_salvaged(const fs::path& path) {
  if (!is_there(salvaged_file(path))) return;
  const auto old = beside(path, ".damaged");
  if (is_there(path)) {
    remove_file(beside(old, "-wal"));
    rename_file(path, old);
  }
  if (is_there(beside(path, "-wal"))) rename_file(beside(path, "-wal"), beside(old, "-wal"));
  remove_file(beside(path, "-shm"));
  remove_file(beside(path, "-journal"));
  rename_file(salvaged_file(path), path);
  synchronise_folder(folder_of(path));
}

}  // namespace kith
