#include "kith/study/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/team_codec.hpp"
#include "sqlite.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "kith.journal/1";

double now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

fs::path beside(const fs::path& path, const char* suffix) { return fs::path{path}.concat(suffix); }

constexpr const char* kTables =
    "PRAGMA application_id = 0x6B697468;"  // "kith"
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;"
    "CREATE TABLE units(team INTEGER PRIMARY KEY, record BLOB NOT NULL) STRICT;"
    "CREATE TABLE failures(team INTEGER PRIMARY KEY, message TEXT NOT NULL) STRICT;"
    "CREATE TABLE sessions(id INTEGER PRIMARY KEY, started REAL NOT NULL) STRICT;"
    "CREATE TABLE batches(id INTEGER PRIMARY KEY, session INTEGER NOT NULL, written REAL NOT NULL,"
    " teams INTEGER NOT NULL) STRICT;";

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
                                                        {"program", identity.program},
                                                        {"study", identity.inputs.study},
                                                        {"domain", identity.inputs.domain},
                                                        {"teams", std::to_string(identity.teams)},
                                                        {"shard", std::to_string(identity.shard.index)},
                                                        {"shards", std::to_string(identity.shard.count)}};
  if (!identity.inputs.files.empty()) meta.emplace_back("files", text_of(identity.inputs.files));
  Sha256 hash;
  for (const auto& [key, value] : meta) hash.update(key + "=" + value + "\n");
  meta.emplace_back("checksum", std::move(hash).hex());
  return meta;
}

std::string meta_value(Database& database, const std::string& key) {
  auto statement = database.prepare("SELECT value FROM meta WHERE key = ?");
  statement.bind_text(1, key);
  return statement.step() ? std::string{statement.text(0)} : std::string{};
}

std::size_t number_of(const std::string& text) {
  std::size_t value = 0;
  for (const char c : text) value = c >= '0' && c <= '9' ? value * 10 + static_cast<std::size_t>(c - '0') : 0;
  return value;
}

[[noreturn]] void beyond_help(const fs::path& path) {
  throw Error{ErrorKind::kIo, path.string() +
                                  " is damaged beyond help: it does not say whose work it holds. Move it away, or "
                                  "start the study over with --resume never"};
}

// @throws kith::Error if the file does not say it, or says it in a way that its checksum does not confirm.
JournalIdentity read_identity(Database& database) {
  try {
    const auto schema = meta_value(database, "schema");
    if (!schema.empty() && schema != kSchema) {
      throw Error{ErrorKind::kUsage, database.path().string() + " was written by another version of kith (" + schema +
                                         ", not " + kSchema + "); start the study over with --resume never"};
    }
    JournalIdentity identity{
        {meta_value(database, "study"), meta_value(database, "domain"), files_from(meta_value(database, "files"))},
        meta_value(database, "program"),
        number_of(meta_value(database, "teams")),
        {number_of(meta_value(database, "shard")), number_of(meta_value(database, "shards"))}};
    for (const auto& [key, value] : meta_of(identity)) {
      if (meta_value(database, key) != value) beyond_help(database.path());
    }
    return identity;
  } catch (const SqliteError& error) {
    if (error.damaged()) beyond_help(database.path());
    throw;
  }
}

bool is_sound(Database& database) {
  try {
    auto check = database.prepare("PRAGMA quick_check(1)");
    return check.step() && check.text(0) == "ok";
  } catch (const SqliteError& error) {
    if (error.damaged()) return false;
    throw;
  }
}

bool belongs(const JournalIdentity& identity, std::int64_t team) {
  return team >= 1 && static_cast<std::size_t>(team) <= identity.teams &&
         identity.shard.contains(static_cast<std::size_t>(team));
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

// The file is complete before it has its name, so whoever finds it by this name finds a journal. Therefore one
// synchronisation at the end will do, instead of one for each of SQLite's steps.
void make_file(const fs::path& path, const JournalIdentity& identity) {
  {
    Database database{path, Database::Mode::kMake};
    database.execute("PRAGMA synchronous = OFF; PRAGMA journal_mode = WAL; BEGIN");
    database.execute(kTables);
    auto insert = database.prepare("INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] : meta_of(identity)) insert.bind_text(1, key).bind_text(2, value).run();
    database.execute("COMMIT");
  }
  synchronise(path);
}

void rename_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw Error{ErrorKind::kIo, "cannot write " + to.string() + ": " + error.message()};
}

}  // namespace

struct Journal::State {
  Database database;
  JournalIdentity identity;
  std::vector<bool> done;
  std::size_t num_done = 0;
  std::vector<std::size_t> damaged;
  bool recovered = false;
  std::int64_t session = 0;

  State(Database file, JournalIdentity whose) : database{std::move(file)}, identity{std::move(whose)} {
    done.resize(identity.teams);
  }

  void mark(std::size_t team) {
    if (!done[team - 1]) ++num_done;
    done[team - 1] = true;
  }

  // Finds out which teams are there. Returns false if the file is damaged.
  bool scan() {
    if (!is_sound(database)) return false;
    try {
      auto rows = database.prepare("SELECT team, record FROM units ORDER BY team");
      while (rows.step()) {
        const auto team = rows.integer(0);
        if (!belongs(identity, team)) continue;
        if (is_intact(static_cast<std::size_t>(team), rows.blob(1))) {
          mark(static_cast<std::size_t>(team));
        } else {
          damaged.push_back(static_cast<std::size_t>(team));
        }
      }
    } catch (const SqliteError& error) {
      if (error.damaged()) return false;
      throw;
    }
    return true;
  }
};

namespace {

// What can be read of a damaged file, team by team, goes to a new file at `to`.
void salvage(Database& from, const JournalIdentity& identity, const fs::path& to) {
  Journal::remove(to);
  make_file(to, identity);
  Database database{to, Database::Mode::kWrite};
  database.execute("PRAGMA synchronous = FULL; BEGIN");
  auto insert = database.prepare("INSERT INTO units VALUES (?, ?)");
  for (std::size_t team = 1; team <= identity.teams; ++team) {
    if (!identity.shard.contains(team)) continue;
    try {
      auto find = from.prepare("SELECT record FROM units WHERE team = ?");
      find.bind(1, static_cast<std::int64_t>(team));
      if (!find.step() || !is_intact(team, find.blob(0))) continue;
      insert.bind(1, static_cast<std::int64_t>(team)).bind_blob(2, find.blob(0)).run();
    } catch (const SqliteError& error) {
      if (!error.damaged()) throw;  // else this team is lost and will be taught again
    }
  }
  database.execute("COMMIT");
}

}  // namespace

Journal::Journal(std::unique_ptr<State> state) : state_{std::move(state)} {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

void Journal::remove(const fs::path& path) {
  for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::error_code error;
    fs::remove(beside(path, suffix), error);
    if (error) throw Error{ErrorKind::kIo, "cannot remove " + path.string() + suffix + ": " + error.message()};
  }
}

Journal Journal::create(const fs::path& path, const JournalIdentity& identity) {
  const auto fresh = beside(path, ".new");
  remove(fresh);
  remove(path);
  make_file(fresh, identity);
  rename_file(fresh, path);
  auto state = std::make_unique<State>(Database{path, Database::Mode::kWrite}, identity);
  state->database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
  return Journal{std::move(state)};
}

Journal Journal::open(const fs::path& path) {
  const auto opened = [&] {
    Database database{path, Database::Mode::kWrite};
    auto identity = read_identity(database);
    return std::make_unique<State>(std::move(database), std::move(identity));
  };
  auto state = opened();
  bool recovered = false;
  if (!state->scan()) {
    const auto fresh = beside(path, ".new");
    salvage(state->database, state->identity, fresh);
    state.reset();
    const auto old = beside(path, ".damaged");
    remove(old);
    rename_file(path, old);
    remove(path);  // the files beside it
    rename_file(fresh, path);
    state = opened();
    if (!state->scan()) beyond_help(path);
    recovered = true;
  }
  state->recovered = recovered;
  // The switch to WAL leaves a transaction open, which the next statement ends; close() could not do its work inside
  // it.
  state->database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; SELECT key FROM meta LIMIT 1");
  return Journal{std::move(state)};
}

Journal Journal::read(const fs::path& path) {
  Database database{path, Database::Mode::kRead};
  auto identity = read_identity(database);
  return Journal{std::make_unique<State>(std::move(database), std::move(identity))};
}

const fs::path& Journal::path() const { return state_->database.path(); }
const JournalIdentity& Journal::identity() const { return state_->identity; }
const std::vector<bool>& Journal::done() const { return state_->done; }
std::size_t Journal::num_done() const { return state_->num_done; }
const std::vector<std::size_t>& Journal::damaged() const { return state_->damaged; }
bool Journal::was_recovered() const { return state_->recovered; }

void Journal::begin_session() {
  auto& database = state_->database;
  auto insert = database.prepare("INSERT INTO sessions(started) VALUES (?) RETURNING id");
  insert.bind(1, now());
  if (insert.step()) state_->session = insert.integer(0);
  insert.run();
}

void Journal::write(std::span<const JournalEntry> entries, std::span<const TeamFailure> failures) {
  if (entries.empty() && failures.empty()) return;
  auto& database = state_->database;
  database.execute("BEGIN IMMEDIATE");
  try {
    auto insert = database.prepare("INSERT OR REPLACE INTO units VALUES (?, ?)");
    auto forgive = database.prepare("DELETE FROM failures WHERE team = ?");
    for (const auto& [team, bytes] : entries) {
      const auto number = static_cast<std::int64_t>(team);
      insert.bind(1, number).bind_blob(2, bytes).run();
      forgive.bind(1, number).run();
    }
    auto fail = database.prepare("INSERT OR REPLACE INTO failures VALUES (?, ?)");
    for (const auto& [team, message] : failures) {
      fail.bind(1, static_cast<std::int64_t>(team)).bind_text(2, message).run();
    }
    auto batch = database.prepare("INSERT INTO batches(session, written, teams) VALUES (?, ?, ?)");
    batch.bind(1, state_->session).bind(2, now()).bind(3, static_cast<std::int64_t>(entries.size())).run();
    database.execute("COMMIT");
  } catch (...) {
    try {
      database.execute("ROLLBACK");
    } catch (const Error&) {  // SQLite has rolled back by itself
    }
    throw;
  }
  for (const auto& entry : entries) state_->mark(entry.team);
}

void Journal::absorb(const Journal& other) {
  constexpr std::size_t kBatchBytes = std::size_t{16} << 20;
  std::vector<JournalEntry> batch;
  std::size_t bytes = 0;
  const auto save = [&] {
    write(batch);
    batch.clear();
    bytes = 0;
  };
  auto rows = other.state_->database.prepare("SELECT team, record FROM units ORDER BY team");
  while (rows.step()) {
    const auto number = rows.integer(0);
    const auto team = static_cast<std::size_t>(number);
    if (!belongs(identity(), number) || done()[team - 1] || !is_intact(team, rows.blob(1))) continue;
    batch.push_back({team, std::string{rows.blob(1)}});
    bytes += batch.back().bytes.size();
    if (bytes > kBatchBytes) save();
  }
  save();
  write({}, other.progress().failures);
}

void Journal::close() {
  state_->database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  // A reader that is looking just now keeps the file in WAL mode, which is no harm.
  try {
    state_->database.execute("PRAGMA journal_mode = DELETE");
  } catch (const Error&) {
  }
}

void Journal::for_each(const std::function<void(std::size_t team, std::string_view bytes)>& visit) const {
  auto rows = state_->database.prepare("SELECT team, record FROM units ORDER BY team");
  while (rows.step()) {
    const auto number = rows.integer(0);
    if (!belongs(identity(), number)) continue;
    const auto team = static_cast<std::size_t>(number);
    if (!is_intact(team, rows.blob(1))) {
      throw Error{ErrorKind::kIo, "the record of team " + std::to_string(team) + " in " + path().string() +
                                      " is damaged; the command that ran the study teaches it again"};
    }
    visit(team, rows.blob(1));
  }
}

std::optional<std::string> Journal::find(std::size_t team) const {
  auto row = state_->database.prepare("SELECT record FROM units WHERE team = ?");
  row.bind(1, static_cast<std::int64_t>(team));
  if (!row.step()) return std::nullopt;
  return std::string{row.blob(0)};
}

JournalProgress Journal::progress() const {
  auto& database = state_->database;
  JournalProgress progress;
  const auto& [index, count] = identity().shard;
  progress.total = identity().teams / count + (index <= identity().teams % count ? 1u : 0u);
  auto units = database.prepare("SELECT count(*) FROM units");
  if (units.step()) progress.done = static_cast<std::size_t>(units.integer(0));
  auto failures = database.prepare("SELECT team, message FROM failures ORDER BY team");
  while (failures.step()) {
    progress.failures.push_back({static_cast<std::size_t>(failures.integer(0)), std::string{failures.text(1)}});
  }
  auto session = database.prepare("SELECT id, started FROM sessions ORDER BY id DESC LIMIT 1");
  if (!session.step()) return progress;
  progress.started = session.real(1);
  auto batches =
      database.prepare("SELECT coalesce(sum(teams), 0), coalesce(max(written), 0.0) FROM batches WHERE session = ?");
  batches.bind(1, session.integer(0));
  if (batches.step()) {
    progress.session_teams = static_cast<std::size_t>(batches.integer(0));
    progress.last_write = batches.real(1);
  }
  return progress;
}

std::string journal_library_version() { return sqlite_version(); }

std::optional<RunInputs> journal_inputs(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  try {
    return Journal::read(path).identity().inputs;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace kith
