#include "kith/study/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <memory>
#include <system_error>

#include "kith/core/error.hpp"
#include "kith/study/sha256.hpp"
#include "kith/study/tables.hpp"
#include "kith/table/atomic_file.hpp"
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

void synchronise_folder(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)fsync(descriptor);
  close(descriptor);
}

// A file's text, or nothing if there is no such file.
std::optional<std::string> text_if_any(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return read_file(path);
}

// The tables and the codebook, in `folder`; their hashes by name.
std::map<std::string, std::string> write_tables(const fs::path& folder, const Study& study,
                                                std::span<const TeamRecord> teams) {
  make_folder(folder);
  std::map<std::string, std::unique_ptr<AtomicFile>> files;
  write_study_tables(study, teams, [&](std::string_view file, std::string_view piece) {
    auto& slot = files[std::string{file}];
    if (!slot) slot = std::make_unique<AtomicFile>(folder / file);
    slot->write(piece);
  });
  for (auto& [name, file] : files) file->commit();
  write_file_atomically(folder / "codebook.json", study_codebook(study));
  std::map<std::string, std::string> hashes;
  for (const auto& [name, file] : files) hashes[name] = sha256(read_file(folder / name));
  hashes["codebook.json"] = sha256(study_codebook(study));
  return hashes;
}

}  // namespace

RunInputs freeze(const StudyReading& reading) {
  auto study = reading.study.value();
  for (auto& variant : study.variants) variant.domain = kFrozenDomain;
  return {to_toml(study, reading.domain.value()), reading.domain_text};
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
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  // Some network file systems have no locks; everywhere else a lock that is taken is another process.
  if (errno == EWOULDBLOCK) throw Error{ErrorKind::kBusy, "another process is writing to " + path_.string()};
}

void RunFolder::check_content(bool replace) {
  bool empty = true;
  for (const auto& entry : fs::directory_iterator{path_}) {
    if (entry.path().filename().string().rfind(kStagingPrefix, 0) == 0) {
      fs::remove_all(entry.path());  // left by a run that was killed; we hold the lock
    } else {
      empty = false;
    }
  }
  if (empty) return;
  const auto study = text_if_any(path_ / "inputs" / "study.toml");
  const auto domain = text_if_any(path_ / "inputs" / kFrozenDomain);
  const bool same = study == inputs_.study && domain == inputs_.domain;
  has_results_ = same;
  if (same || replace) return;
  if (!study) {
    throw Error{ErrorKind::kUsage, path_.string() +
                                       " is not empty and no run folder; choose another folder, or add --yes to "
                                       "write into it"};
  }
  throw Error{ErrorKind::kUsage, path_.string() +
                                     " holds the results of a different study (see its inputs/study.toml); "
                                     "choose another folder, or add --yes to replace them"};
}

void RunFolder::publish(const Study& study, std::span<const TeamRecord> teams, const RunFacts& facts) {
  const auto hashes = write_tables(staging_ / "tables", study, teams);
  make_folder(staging_ / "inputs");
  write_file_atomically(staging_ / "inputs" / "study.toml", inputs_.study);
  write_file_atomically(staging_ / "inputs" / kFrozenDomain, inputs_.domain);
  put_in_place(staging_ / "inputs", path_ / "inputs");
  put_in_place(staging_ / "tables", path_ / "tables");
  synchronise_folder(path_);
  published_ = true;
  std::string log;
  for (const auto& line : facts.log) log += line + "\n";
  write_file_atomically(path_ / "log.txt", log);
  write_file_atomically(path_ / "timings.csv", timings_table(facts));
  write_file_atomically(path_ / "manifest.json", manifest(study, teams.size(), inputs_, hashes, facts));
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
