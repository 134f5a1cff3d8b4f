#include "kith/runs/journal.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "journal_file.hpp"
#include "kith/core/error.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"
#include "kith/files/sqlite.hpp"
#include "kith/runs/team_codec.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

// What a failure begins with under its seal; a record of a team begins otherwise.
constexpr char kFailure = 0;

double now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

}  // namespace

std::string JournalIdentity::key() const {
  Sha256 hash;
  for (const auto& part : {std::string{"kith.record/2"}, inputs.digest(), program}) hash.update(part + "\n");
  return std::move(hash).digest();
}

struct Journal::State {
  Database database;
  JournalIdentity identity;
  std::string key;
  std::vector<bool> done;
  std::size_t num_done = 0;
  std::vector<std::size_t> damaged;
  bool recovered = false;
  std::int64_t session = 0;

  State(Database file, JournalIdentity whose)
      : database{std::move(file)}, identity{std::move(whose)}, key{identity.key()} {
    done.resize(identity.teams);
  }

  void mark(std::size_t team) {
    if (!done[team - 1]) ++num_done;
    done[team - 1] = true;
  }

  // Whether the file alone holds records that it does not show together with the log beside it: then that log is of
  // another run, or of an earlier state of this one.
  [[nodiscard]] bool lacks_records_of(const fs::path& path) const {
    try {
      Database alone{path, Database::Mode::kAlone};
      auto rows = alone.prepare("SELECT team, record FROM units");
      while (rows.step()) {
        const auto team = rows.integer(0);
        if (!belongs(identity, team) || done[static_cast<std::size_t>(team) - 1]) continue;
        if (is_intact(static_cast<std::size_t>(team), rows.blob(1), key)) return true;
      }
    } catch (const SqliteError& error) {
      if (!error.damaged()) throw;  // else the log was being put into the file, and completes it
    }
    return false;
  }

  // Finds out which teams are there. Returns false if the file is damaged.
  bool scan() {
    done.assign(identity.teams, false);
    num_done = 0;
    damaged.clear();
    if (!is_sound(database, SqliteCheck::kPages)) return false;
    try {
      auto rows = database.prepare("SELECT team, record FROM units ORDER BY team");
      while (rows.step()) {
        const auto team = rows.integer(0);
        if (!belongs(identity, team)) continue;
        if (is_intact(static_cast<std::size_t>(team), rows.blob(1), key)) {
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

Journal::Journal(std::unique_ptr<State> state) : state_{std::move(state)} {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

void Journal::remove(const fs::path& path) {
  for (const auto* name : {".salvaged", ".salvaging", ".new", ""}) {
    for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) {
      const auto file = fs::path{path}.concat(name).concat(suffix);
      std::error_code error;
      fs::remove(file, error);
      if (error) throw Error{ErrorKind::kIo, "cannot remove " + file.string() + ": " + error.message()};
    }
  }
}

bool Journal::exists(const fs::path& path) { return is_there(path) || is_there(salvaged_file(path)); }

std::optional<JournalIdentity> Journal::identify(const fs::path& path) {
  const auto file = current_file(path);
  if (!file) return std::nullopt;
  try {
    // The file alone has said so from the beginning; what is beside it may not be its own.
    Database database{*file, Database::Mode::kAlone};
    return read_identity(database);
  } catch (const SqliteError& error) {
    if (error.damaged()) return std::nullopt;
    throw;
  }
}

Journal Journal::create(const fs::path& path, const JournalIdentity& identity) {
  remove(path);
  make_journal_file(path, identity);
  auto state = std::make_unique<State>(Database{path, Database::Mode::kWrite}, identity);
  state->database.execute("PRAGMA synchronous = FULL");
  return Journal{std::move(state)};
}

std::optional<Journal> Journal::open(const fs::path& path, const JournalIdentity& identity) {
  replace_by_salvaged(path);
  // Its state, if all of it is sound and of this identity. Until that is known the log is not put into the file: it
  // could be that of another journal.
  const auto sound_state = [&]() -> std::unique_ptr<State> {
    try {
      Database database{path, Database::Mode::kWrite};
      database.keep_log(true);
      const auto whose = read_identity(database);
      if (!whose || *whose != identity) return nullptr;
      auto state = std::make_unique<State>(std::move(database), identity);
      std::error_code none;
      const bool has_log = fs::file_size(fs::path{path}.concat("-wal"), none) > 0 && !none;
      if (!state->scan()) return nullptr;
      if (has_log && (!state->damaged.empty() || state->lacks_records_of(path))) return nullptr;
      state->database.keep_log(false);
      return state;
    } catch (const SqliteError& error) {
      if (error.damaged()) return nullptr;
      throw;
    }
  };

  const auto whose = identify(path);
  if (whose && *whose != identity) {
    throw Error{ErrorKind::kUsage, path.string() + " belongs to another study, shard or program"};
  }
  auto state = whose ? sound_state() : nullptr;
  if (!state) {
    if (!salvage_journal(path, identity, whose.has_value())) return std::nullopt;
    state = sound_state();
    if (!state) throw Error{ErrorKind::kIo, "cannot write " + path.string() + ": reading it back gave different data"};
    state->recovered = true;
  }
  state->database.execute("PRAGMA synchronous = FULL");
  return Journal{std::move(state)};
}

Journal Journal::read(const fs::path& path) {
  const auto file = current_file(path).value_or(path);
  // Whoever writes to it has made sure that the log is its own. Meanwhile the file alone can look damaged: when the log
  // is put into it, its first page names pages that follow later.
  const bool is_written = is_busy(path.parent_path());
  Database database{file, Database::Mode::kRead};
  auto identity = read_identity(database);
  if (!identity || (!is_written && identify(path) != identity)) {
    refuse_run(ErrorKind::kIo, "E0643", file, "the journal is damaged",
               {"rerun the command that ran the study, which recovers what can be read", Remedy::kStartOver});
  }
  return Journal{std::make_unique<State>(std::move(database), *std::move(identity))};
}

const fs::path& Journal::path() const { return state_->database.path(); }
const JournalIdentity& Journal::identity() const { return state_->identity; }
const std::string& Journal::key() const { return state_->key; }
const std::vector<bool>& Journal::done() const { return state_->done; }
std::size_t Journal::num_done() const { return state_->num_done; }
const std::vector<std::size_t>& Journal::damaged() const { return state_->damaged; }
bool Journal::was_recovered() const { return state_->recovered; }
bool Journal::check() { return state_->scan(); }

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
  database.transaction([&] {
    auto insert = database.prepare("INSERT OR REPLACE INTO units VALUES (?, ?)");
    auto forgive = database.prepare("DELETE FROM failures WHERE team = ?");
    for (const auto& [team, bytes] : entries) {
      const auto number = static_cast<std::int64_t>(team);
      insert.bind(1, number).bind_blob(2, bytes).run();
      forgive.bind(1, number).run();
    }
    auto fail = database.prepare("INSERT OR REPLACE INTO failures VALUES (?, ?)");
    for (const auto& [team, message] : failures) {
      const auto sealed = seal_record(team, kFailure + message, state_->key);
      fail.bind(1, static_cast<std::int64_t>(team)).bind_blob(2, sealed).run();
    }
    auto batch = database.prepare("INSERT INTO batches(session, written, teams) VALUES (?, ?, ?)");
    batch.bind(1, state_->session).bind(2, now()).bind(3, static_cast<std::int64_t>(entries.size())).run();
  });
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
    if (!belongs(identity(), number) || done()[team - 1] || !is_intact(team, rows.blob(1), state_->key)) continue;
    batch.push_back({team, std::string{rows.blob(1)}});
    bytes += batch.back().bytes.size();
    if (bytes > kBatchBytes) save();
  }
  save();
  write({}, other.progress().failures);
}

void Journal::close() {
  try {
    state_->database.empty_log();
  } catch (const SqliteError& error) {
    if (error.kind() != ErrorKind::kBusy) throw;  // a reader is looking just now: what is beside the file stays there
  }
}

void Journal::for_each(const std::function<void(std::size_t team, std::string_view bytes)>& visit) const {
  auto rows = state_->database.prepare("SELECT team, record FROM units ORDER BY team");
  while (rows.step()) {
    const auto number = rows.integer(0);
    if (!belongs(identity(), number)) continue;
    const auto team = static_cast<std::size_t>(number);
    if (!is_intact(team, rows.blob(1), state_->key)) {
      throw Error{ErrorKind::kIo, "the record of team " + std::to_string(team) + " in " + path().string() +
                                      " is damaged; rerun the command that ran the study to repeat the team"};
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
    const auto team = failures.integer(0);
    if (!belongs(identity(), team)) continue;
    const auto message = unseal_record(static_cast<std::size_t>(team), failures.blob(1), state_->key);
    if (!message || message->empty() || message->front() != kFailure) continue;  // it is tried again
    progress.failures.push_back({static_cast<std::size_t>(team), std::string{message->substr(1)}});
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

}  // namespace kith
