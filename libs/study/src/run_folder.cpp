#include "kith/study/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/sha256.hpp"
#include "kith/study/journal.hpp"
#include "kith/study/tables.hpp"
#include "manifest.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrozenDomain = "domain.toml";
constexpr const char* kStagingPrefix = ".kith-staging-";

[[noreturn]] void fail(const std::string& action, const fs::path& path, int error) {
  throw Error{ErrorKind::kIo, "cannot " + action + " " + path.string() + ": " + std::generic_category().message(error)};
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail("make the folder", path, error.value());
}

// Puts the folder `from` in the place of `to`, which may exist; in one step where the file system can.
void put_in_place(const fs::path& from, const fs::path& to) {
  if (rename(from.c_str(), to.c_str()) == 0) return;  // nothing there, or an empty folder
  if (errno != ENOTEMPTY && errno != EEXIST) fail("replace", to, errno);
  constexpr unsigned kExchange = 2;  // RENAME_EXCHANGE
  if (syscall(SYS_renameat2, AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), kExchange) == 0) return;
  const auto old = fs::path{from}.concat("-old");
  if (rename(to.c_str(), old.c_str()) != 0) fail("replace", to, errno);
  if (rename(from.c_str(), to.c_str()) != 0) {
    const int error = errno;
    (void)rename(old.c_str(), to.c_str());
    fail("replace", to, error);
  }
}

// A file's text, or nothing if there is no such file.
std::optional<std::string> text_if_any(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return read_file(path);
}

// What write_tables() leaves behind.
struct WrittenTables {
  std::map<std::string, std::string> hashes;  // by name
  std::size_t teams = 0;
};

// The tables and the codebook, in `folder`.
WrittenTables write_tables(const fs::path& folder, const Study& study, const TeamSource& teams) {
  struct Table {
    explicit Table(const fs::path& path) : file{path} {}
    AtomicFile file;
    Sha256 hash;
  };
  make_folder(folder);
  WrittenTables written;
  std::map<std::string, std::unique_ptr<Table>, std::less<>> tables;
  const TeamSource counted = [&](const std::function<void(const TeamRecord& team)>& visit) {
    teams([&](const TeamRecord& team) {
      ++written.teams;
      visit(team);
    });
  };
  write_study_tables(study, counted, [&](std::string_view name, std::string_view piece) {
    auto found = tables.find(name);
    if (found == tables.end()) found = tables.emplace(name, std::make_unique<Table>(folder / name)).first;
    found->second->file.write(piece);
    found->second->hash.update(piece);
  });
  for (auto& [name, table] : tables) {
    table->file.commit(FolderSync::kLater);
    written.hashes[name] = std::move(table->hash).hex();
  }
  const auto codebook = study_codebook(study);
  write_file_atomically(folder / "codebook.json", codebook);  // and the entries of all of them
  written.hashes["codebook.json"] = sha256(codebook);
  return written;
}

}  // namespace

RunInputs freeze(const StudyReading& reading) {
  auto study = reading.study.value();
  for (auto& variant : study.variants) variant.domain = kFrozenDomain;
  RunInputs inputs{to_toml(study, reading.domain.value()), reading.domain_text, {}};
  for (const auto& file : reading.domain_files) inputs.files.push_back({file.name, sha256(file.text), file.text});
  return inputs;
}

RunFolder::RunFolder(fs::path path, RunInputs inputs, bool replace)
    : path_{std::move(path)}, inputs_{std::move(inputs)} {
  std::error_code error;
  made_ = !fs::exists(path_, error);
  make_folder(path_);
  try {
    lock();
    check_content(replace);
    staging_ = path_ / (kStagingPrefix + std::to_string(getpid()));
    if (mkdir(staging_.c_str(), 0777) != 0) fail("write to", path_, errno);
  } catch (...) {
    if (made_) fs::remove(path_, error);  // only if it is empty
    if (descriptor_ >= 0) close(descriptor_);
    throw;
  }
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (made_ && !published_) fs::remove(path_, ignored);
  close(descriptor_);
}

void RunFolder::lock() {
  descriptor_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) fail("open the folder", path_, errno);
  // Whoever looks whether the folder is busy holds it for an instant; a run holds it for longer than that.
  for (int attempt = 0; attempt < 5; ++attempt) {
    if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) return;  // some network file systems have no locks
    usleep(20'000);
  }
  throw Error{ErrorKind::kBusy, "another process is writing to " + path_.string()};
}

void RunFolder::check_content(bool replace) {
  bool empty = true;
  for (const auto& entry : fs::directory_iterator{path_}) {
    const auto name = entry.path().filename().string();
    if (name.rfind(kStagingPrefix, 0) == 0 || name.rfind(std::string{kJournalFile} + ".new", 0) == 0) {
      fs::remove_all(entry.path());  // left by a run that was killed; we hold the lock
    } else {
      empty = false;
    }
  }
  if (empty) return;
  const auto study = text_if_any(path_ / "inputs" / "study.toml");
  const auto domain = text_if_any(path_ / "inputs" / kFrozenDomain);
  has_inputs_ = study == inputs_.study && domain == inputs_.domain && has_files();
  has_results_ = has_inputs_ && fs::exists(path_ / "manifest.json");
  // A run that has begun to replace another one's results has a journal of its own.
  const auto begun = journal_inputs(path_ / kJournalFile);
  if (replace || (begun ? *begun == inputs_ : has_inputs_)) return;
  if (!study && !begun && !fs::exists(path_ / kJournalFile)) {
    throw Error{ErrorKind::kUsage, path_.string() +
                                       " is not empty and no run folder; choose another folder, or add --yes to "
                                       "write into it"};
  }
  if (!study && !begun) return;  // only a journal that cannot be read, which is for whoever opens it to say
  throw Error{ErrorKind::kUsage, path_.string() + " holds the results of a different study" +
                                     (study ? " (see its inputs/study.toml)" : ", unfinished") +
                                     "; choose another folder, or add --yes to replace them"};
}

bool RunFolder::has_files() const {
  return std::all_of(inputs_.files.begin(), inputs_.files.end(),
                     [&](const InputFile& file) { return text_if_any(path_ / "inputs" / file.name) == file.text; });
}

void RunFolder::reach(const std::string& instant) const {
  if (observer_) observer_(instant);
}

void RunFolder::freeze_inputs() {
  std::error_code ignored;
  if (!fs::exists(path_ / "inputs", ignored)) put_inputs();
}

void RunFolder::put_inputs() {
  make_folder(staging_ / "inputs");
  write_file_atomically(staging_ / "inputs" / "study.toml", inputs_.study, FolderSync::kLater);
  for (const auto& file : inputs_.files) {
    make_folder((staging_ / "inputs" / file.name).parent_path());
    write_file_atomically(staging_ / "inputs" / file.name, file.text);
  }
  write_file_atomically(staging_ / "inputs" / kFrozenDomain, inputs_.domain);
  put_in_place(staging_ / "inputs", path_ / "inputs");
  has_inputs_ = true;
}

void RunFolder::discard() {
  std::error_code ignored;
  Journal::remove(path_ / kJournalFile);
  if (made_ && !published_) fs::remove_all(path_ / "inputs", ignored);
}

void RunFolder::publish(const Study& study, std::span<const TeamRecord> teams, const RunFacts& facts) {
  publish(
      study,
      [&](const std::function<void(const TeamRecord& team)>& visit) {
        for (const auto& team : teams) visit(team);
      },
      facts);
}

void RunFolder::publish(const Study& study, const TeamSource& teams, const RunFacts& facts) {
  const auto written = write_tables(staging_ / "tables", study, teams);
  reach("staged");
  if (!has_inputs_) put_inputs();
  reach("inputs");
  put_in_place(staging_ / "tables", path_ / "tables");
  synchronise_folder(path_);
  published_ = true;
  reach("tables");
  std::string log;
  for (const auto& line : facts.log) log += line + "\n";
  write_file_atomically(path_ / "log.txt", log, FolderSync::kLater);
  write_file_atomically(path_ / "timings.csv", timings_table(facts), FolderSync::kLater);
  write_file_atomically(path_ / "manifest.json", manifest(study, written.teams, inputs_, written.hashes, facts));
  reach("manifest");
}

bool is_busy(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool busy = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return busy;
}

StudyReading read_run_folder(const fs::path& path) {
  const auto file = path / "inputs" / "study.toml";
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw Error{ErrorKind::kIo, path.string() + " is not a run folder: it has no inputs/study.toml"};
  }
  return load_study(file.string());
}

}  // namespace kith
